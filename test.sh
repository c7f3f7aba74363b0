#!/bin/bash
# Installs what is missing, builds sundog and its tests, and runs them all. Arguments go to ctest.
set -eu
root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*}
stamp=$root/build/release/built-tests  # younger than every source: there is nothing to do
sources=("$root"/{host,kernels,cmake,tests,bench,CMakeLists.txt,CMakePresets.json})

if [[ ! -e $stamp || -n $(find "${sources[@]}" -newer "$stamp" -print -quit) ]]; then
  "$root/cmake/prepare.sh" tests
fi
cd "$root"
if [[ ! -e build/release/sundog_mpi.so ]]; then
  echo "sundog: built without Open MPI (libopenmpi-dev, openmpi-bin): the tests of mpirun are left out" >&2
fi
exec ctest --preset release --parallel "$(nproc)" "$@"
