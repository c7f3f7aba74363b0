#!/bin/bash
# Installs what is missing, builds what has changed, and runs sundog with the arguments given:
#   ./run.sh render scenes/hollow_ice.json -o hollow_ice.png
# When nothing has changed since the last call it only starts the program.
set -eu
root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*}
sundog=$root/build/release/sundog
stamp=$root/build/release/built-program  # younger than every source: there is nothing to do
sources=("$root"/{host,kernels,cmake,third_party,CMakeLists.txt,CMakePresets.json})

if [[ ! -x $sundog || ! -e $stamp || -n $(find "${sources[@]}" -newer "$stamp" -print -quit) ]]; then
  "$root/cmake/prepare.sh" program >&2
fi
exec "$sundog" "$@"
