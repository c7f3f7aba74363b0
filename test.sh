#!/bin/bash
# Installs missing packages, checks the sources, builds sundog and its tests, and runs all tests. Arguments go
# to ctest.
set -eu
root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*}
stamp=$root/build/release/built-tests  # newer than every source if there is nothing to build
sources=("$root"/{host,include,examples,python,kernels,cmake,third_party,tests,bench,CMakeLists.txt,CMakePresets.json,pyproject.toml})

if [[ ! -e $stamp || -n $(find "${sources[@]}" -newer "$stamp" -print -quit) ]]; then
  "$root/cmake/prepare.sh" packages
  "$root/tests/check_format.sh"
  "$root/tests/tidy.sh"
  "$root/cmake/prepare.sh" tests
fi
cd "$root"
left_out() { echo "sundog: no $1 here: the tests $2 are left out" >&2; }
[[ -e build/release/sundog_mpi.so ]] || left_out "Open MPI (libopenmpi-dev, openmpi-bin)" "of mpirun"
[[ -e build/release/embree_rays ]] || left_out "Embree (libembree-dev)" "that compare with it"
command -v chromedriver >/dev/null || left_out "chromedriver (chromium-driver)" "of the viewer in a browser"
[[ -e build/release/axe-core/package/axe.min.js ]] || left_out "axe-core (cmake/FetchAxe.cmake fetches it where there is a network)" "of its rules"
command -v oclgrind >/dev/null || left_out "Oclgrind" "of memory accesses"
# Tests need a cache of kernels: use the build folder if the user has no cache folder.
cache=${XDG_CACHE_HOME:-${HOME:-}/.cache}
if ! mkdir -p "$cache" 2>/dev/null || [[ ! -w $cache ]]; then
  export XDG_CACHE_HOME=$root/build/release/cache
  mkdir -p -m 700 "$XDG_CACHE_HOME"
fi
# Runs one more test at once than there are processors, because some wait for processes and timers.
exec ctest --preset release --parallel "$(($(nproc) + 1))" "$@"
