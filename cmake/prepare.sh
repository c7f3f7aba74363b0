#!/bin/bash
# Makes build/release ready: `prepare.sh program` for sundog alone, `prepare.sh tests` for the tests too; `prepare.sh packages`
# installs what the latter needs, and builds the program meanwhile. Packages come from apt, and only those that are missing. Quiet
# unless there is something to do; else it says first how much that is.
set -eu
goal=$1
root=$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")
build=$root/build/release

# The build cannot do without these. PoCL is among them, so that the first picture needs no GPU.
needed=(g++ cmake ninja-build ocl-icd-opencl-dev opencl-clhpp-headers pocl-opencl-icd libglm-dev libstb-dev
  libopenexr-dev libspng-dev libdeflate-dev libturbojpeg0-dev libwebp-dev nlohmann-json3-dev libcli11-dev libfmt-dev libtbb-dev zlib1g-dev catch2)
# Debian 12 has Boost 1.81 beside an older one.
if grep -qs '^12' /etc/debian_version; then needed+=(libboost1.81-dev); else needed+=(libboost-dev); fi
# The tests compare with these where they are; Open MPI is what `mpirun sundog` needs; a browser opens the viewer's page; pip
# builds the Python package, pkg-config finds the library, Doxygen reads its headers, and git says what has changed.
peers=(oclgrind mesa-opencl-icd libembree-dev povray clang libopenmpi-dev openmpi-bin chromium chromium-driver
  python3-dev python3-venv pkg-config doxygen git)
# Of one version, so that every machine finds the same: tests/check_format.sh, tests/tidy.sh.
checkers=(clang-format-19 clang-tidy-19)

# Seconds of one core that a build takes with an empty compiler cache, in round figures.
program_work=290
tests_work=600

say() { echo "sundog: $*" >&2; }

# Those of the packages named that are not installed, in one line.
missing_of() {
  local installed package
  installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true)
  for package; do grep -qx "$package installed" <<<"$installed" || echo "$package"; done | xargs
}

as_root() {
  if [[ $EUID == 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    say "cannot install packages: neither root nor sudo. Ask an administrator for: apt-get install $missing"
    exit 1
  fi
}

# "75 packages, 210 MB to fetch, 900 MB on disk", of apt-get's own reckoning.
size_of() {
  LC_ALL=C apt-get install --assume-no --no-install-recommends "$@" 2>/dev/null | awk '
    / newly installed/ { for (i = 2; i <= NF; i++) if ($i == "newly") out = $(i - 1) " packages" }
    /^Need to get / { sub(/^Need to get /, ""); sub(/ of archives.*/, ""); sub(/.*\//, ""); out = out ", " $0 " to fetch" }
    /^After this operation, / { sub(/^After this operation, /, ""); sub(/ of additional.*/, ""); out = out ", " $0 " on disk" }
    END { print out }' || true
}

# "about 3 minutes on 2 cores" for so many seconds of one core.
duration_of() {
  local cores seconds
  cores=$(nproc)
  seconds=$(($1 / cores))
  if ((seconds < 90)); then echo "about $seconds seconds on $cores cores"; else echo "about $(((seconds + 30) / 60)) minutes on $cores cores"; fi
}

# Installs the packages named that are missing; those this distribution does not have are left out.
install_missing() {
  missing=$(missing_of "$@")
  [[ -n $missing ]] || return 0
  if ! command -v apt-get >/dev/null; then
    say "there is no apt-get here; make sure that the equivalents of these are installed: $missing"
    return 0
  fi
  say "packages are missing; asking apt for them"
  as_root apt-get update -qq
  local package available=()
  for package in $missing; do
    if apt-cache show "$package" >/dev/null 2>&1; then available+=("$package"); else say "no package $package here"; fi
  done
  [[ ${#available[@]} == 0 ]] && return 0
  say "installing ${available[*]}: with what they need $(size_of "${available[@]}"); one to three minutes, mostly the download"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${available[@]}"
}

mkdir -p "$build"
exec 9>"$build/lock"
flock 9  # two calls at once take turns

cd "$root"
# Configures, and builds the program, or with `tests` everything.
build() {
  touch "$build/started"  # what changes during the build is built the next time
  local first=() target=sundog
  if [[ ! -e $build/CMakeCache.txt ]]; then first=(-DSUNDOG_UNITY=ON -DSUNDOG_UNITY_TESTS=ON); fi  # a folder of a developer keeps its way
  cmake --preset release "${first[@]}" >"$build/configure.log" 2>&1 || { cat "$build/configure.log" >&2; exit 1; }
  if [[ $1 == tests ]]; then target=all; fi
  if [[ ! -e $build/built-$1 ]]; then
    say "building for the first time: $(duration_of "$([[ $1 == tests ]] && echo "$tests_work" || echo "$program_work")")"
  fi
  cmake --build "$build" --target "$target"
  touch -r "$build/started" "$build/built-program" "$build/built-$1"
}

install_missing "${needed[@]}"
case $goal in
  packages)
    if [[ -n $(missing_of "${peers[@]}" "${checkers[@]}") ]]; then  # the download waits for the network, the compiler does not
      install_missing "${peers[@]}" "${checkers[@]}" &
      build program
      wait $!
    fi
    ;;
  tests)
    install_missing "${peers[@]}" "${checkers[@]}"
    build tests
    ;;
  *) build program ;;
esac
