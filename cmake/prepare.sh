#!/bin/bash
# Prepares build/release, or the folder of the second argument. `prepare.sh program`: builds sundog;
# `prepare.sh tests`: builds the tests too; `prepare.sh packages`: installs the packages for `tests` and
# builds the program meanwhile. Installs missing packages by apt. Prints nothing if there is nothing to do;
# otherwise it first says how much there is.
set -eu
goal=$1
root=$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")
build=${2:-$root/build/release}

# The build needs these. PoCL is among them, so that the first picture needs no GPU.
needed=(g++ cmake ninja-build ocl-icd-opencl-dev opencl-clhpp-headers pocl-opencl-icd libglm-dev libstb-dev
  libopenexr-dev libspng-dev libdeflate-dev libturbojpeg0-dev libwebp-dev nlohmann-json3-dev libcli11-dev libfmt-dev libtbb-dev zlib1g-dev catch2)
# Debian 12 has Boost 1.81 besides an older version.
if grep -qs '^12' /etc/debian_version; then needed+=(libboost1.81-dev); else needed+=(libboost-dev); fi
# Optional packages for tests: peers to compare with; Open MPI for `mpirun sundog`; a browser for the viewer's
# page; pip for the Python package and NVIDIA's compiler, pkg-config for the library, Doxygen for its headers,
# and git for the changed files. clang-19 compiles kernels for GPUs, with the libclc that mesa-opencl-icd brings
# (libclc-19 would remove it). Intel's compiler would be another driver: bench/gpu_compilers.py unpacks it.
peers=(oclgrind mesa-opencl-icd libembree-dev povray clang clang-19 libopenmpi-dev openmpi-bin chromium chromium-driver
  openssl python3-dev python3-venv python3-pip pkg-config doxygen git)
# A fixed version, so that tests/check_format.sh and tests/tidy.sh give equal results on every machine.
checkers=(clang-format-19 clang-tidy-19)

# Seconds of one core that a build takes with an empty compiler cache, in round figures.
program_work=290
tests_work=600

say() { echo "sundog: $*" >&2; }

# Prints the given packages that are not installed, in one line.
missing_of() {
  local installed package
  installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true)
  for package; do grep -qx "$package installed" <<<"$installed" || echo "$package"; done | xargs
}

may_install() { [[ $EUID == 0 ]] || command -v sudo >/dev/null; }

# Runs apt-get as root or by sudo. Waits up to 30 minutes while another program holds apt's locks, as a system
# upgrade may for minutes.
patient_apt() {
  local become=() log=$build/apt.log out=$build/apt.out waited=0
  [[ $EUID == 0 ]] || become=(sudo)
  until "${become[@]}" env LC_ALL=C DEBIAN_FRONTEND=noninteractive apt-get "$@" >"$out" 2>"$log"; do
    if ! grep -qE 'Could not get lock|Unable to (acquire|lock)' "$log" || ((waited >= 1800)); then
      tail -n 20 "$out" >&2
      cat "$log" >&2
      return 1
    fi
    if ((waited == 0)); then say "apt is locked by another program, perhaps the system's own upgrade: waiting for it"; fi
    sleep 2
    waited=$((waited + 2))
  done
}

# Prints "75 packages, 210 MB to fetch, 900 MB on disk" by apt's estimate; needs no privileges and installs
# nothing.
size_of() {
  local all fetched stored
  all=$(apt-get -s -qq install --no-install-recommends "$@" 2>/dev/null | awk '$1 == "Inst" { print $2 }' | xargs)
  fetched=$(apt-get --print-uris -qq install --no-install-recommends "$@" 2>/dev/null | awk '{ n += $3 } END { print n }')
  # shellcheck disable=SC2086  # a list of words
  stored=$(apt-cache show --no-all-versions $all 2>/dev/null | awk '/^Installed-Size:/ { n += $2 } END { print n }')
  echo "$(wc -w <<<"$all") packages, $(((${fetched:-0} + 500000) / 1000000)) MB to fetch, $(((${stored:-0} + 500) / 1000)) MB on disk"
}

# Prints "about 3 minutes on 2 cores" for a number of seconds on one core.
duration_of() {
  local cores seconds
  cores=$(nproc)
  seconds=$(($1 / cores))
  if ((seconds < 90)); then echo "about $seconds seconds on $cores cores"; else echo "about $(((seconds + 30) / 60)) minutes on $cores cores"; fi
}

# Installs the given packages that are missing; skips those that this distribution does not have.
install_missing() {
  local missing package available=()
  missing=$(missing_of "$@")
  [[ -n $missing ]] || return 0
  if ! command -v apt-get >/dev/null; then
    say "there is no apt-get here; make sure that the equivalents of these are installed: $missing"
    return 0
  fi
  say "packages are missing; asking apt for them"
  patient_apt update -qq
  for package in $missing; do
    if apt-cache show "$package" >/dev/null 2>&1; then available+=("$package"); else say "no package $package here"; fi
  done
  [[ ${#available[@]} == 0 ]] && return 0
  say "installing ${available[*]}: with what they need $(size_of "${available[@]}"); one to three minutes, mostly the download ($build/apt.out)"
  patient_apt install -y -qq --no-install-recommends "${available[@]}"
}

# Installs the packages that the build needs.
install_needed() {
  local missing
  missing=$(missing_of "${needed[@]}")
  if [[ -n $missing ]] && command -v apt-get >/dev/null && ! may_install; then
    say "packages are missing, and there is neither root nor sudo to install them: ask an administrator for: apt-get install $missing"
    exit 1
  fi
  install_missing "${needed[@]}"
}

# Installs the optional packages of tests; tests whose packages are missing are skipped.
install_peers() {
  if may_install; then
    install_missing "${peers[@]}" "${checkers[@]}"
  else
    say "neither root nor sudo: tests are left out that need $(missing_of "${peers[@]}" "${checkers[@]}")"
  fi
}

if ! mkdir -p "$build" 2>/dev/null || [[ ! -w $build ]]; then
  say "$build cannot be written: copy the clone to a folder that can be, and build there"
  exit 1
fi
exec 9>"$build/lock"
flock 9  # simultaneous calls take turns

cd "$root"
# Configures and builds the program and its library, or everything with `tests`.
build() {
  touch "$build/started"  # sources that change during the build are built next time
  local first=() targets=(sundog sundog_shared sundog_static)  # the targets that `cmake --install` needs
  if [[ ! -e $build/CMakeCache.txt ]]; then first=(-DSUNDOG_UNITY=ON -DSUNDOG_UNITY_TESTS=ON); fi  # a developer's folder keeps its settings
  cmake --preset release -B "$build" "${first[@]}" >"$build/configure.log" 2>&1 || { cat "$build/configure.log" >&2; exit 1; }
  if [[ $1 == tests ]]; then targets=(all); fi
  if [[ ! -e $build/built-$1 ]]; then
    say "building for the first time: $(duration_of "$([[ $1 == tests ]] && echo "$tests_work" || echo "$program_work")")"
  fi
  cmake --build "$build" --target "${targets[@]}"
  touch -r "$build/started" "$build/built-program" "$build/built-$1"
}

# Builds the program while packages download, as the download waits for the network and the compiler does not.
# The first failure ends both.
build_beside_packages() {
  install_peers &
  local packages=$! program
  set -m  # a process group, so that all its processes can be killed
  build program &
  program=$!
  set +m
  trap "kill -- -$program 2>/dev/null || true" EXIT  # expanded now: the variable is local, the trap is not
  wait -n || { wait "$packages" || say "the packages could not be installed"; exit 1; }
  wait "$packages" || { say "the packages could not be installed"; exit 1; }
  wait "$program"
  trap - EXIT
}

install_needed
case $goal in
  packages) if [[ -n $(missing_of "${peers[@]}" "${checkers[@]}") ]]; then build_beside_packages; fi ;;
  tests)
    install_peers
    build tests
    ;;
  *) build program ;;
esac
