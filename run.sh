#!/bin/bash
# Installs missing packages, builds what has changed, and runs sundog with the given arguments:
#   ./run.sh render scenes/hollow_ice.json -o hollow_ice.png
# If nothing has changed since the last call, it only starts the program.
set -eu
root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*}
build=$root/build/release
if [[ ! -w $root && ! -w $build ]]; then  # a read-only clone
  build=${XDG_CACHE_HOME:-${HOME:-/tmp}/.cache}/sundog-build$root
fi
sundog=$build/sundog
stamp=$build/built-program  # newer than every source if there is nothing to build
sources=("$root"/{host,bench,kernels,cmake,third_party,CMakeLists.txt,CMakePresets.json})

if [[ ! -x $sundog || ! -e $stamp || -n $(find "${sources[@]}" -newer "$stamp" -print -quit) ]]; then
  "$root/cmake/prepare.sh" program "$build" >&2
fi
exec "$sundog" "$@"
