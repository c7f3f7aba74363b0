#!/bin/bash
# Installs what is missing, builds what has changed, and runs sundog with the arguments given:
#   ./run.sh render scenes/hollow_ice.json -o hollow_ice.png
# When nothing has changed since the last call it only starts the program.
set -eu
root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*}
build=$root/build/release
if [[ ! -w $root && ! -w $build ]]; then  # a clone that cannot be written
  build=${XDG_CACHE_HOME:-${HOME:-/tmp}/.cache}/sundog-build$root
fi
sundog=$build/sundog
stamp=$build/built-program  # younger than every source: there is nothing to do
sources=("$root"/{host,bench,kernels,cmake,third_party,CMakeLists.txt,CMakePresets.json})

if [[ ! -x $sundog || ! -e $stamp || -n $(find "${sources[@]}" -newer "$stamp" -print -quit) ]]; then
  "$root/cmake/prepare.sh" program "$build" >&2
fi
exec "$sundog" "$@"
