#!/bin/bash
# Runs clang-tidy and clang-query on the C++ sources of host and bench: those that changed since BASE, or all.
# .clang-tidy has the checks and their reasons, tests/code_rules.query the project's own. Tests are left out,
# because each CHECK of Catch2 looks like a chained comparison.
#   tests/tidy.sh [--all | BASE]
# BASE is a commit; by default the one where this branch left main, or on main itself the previous commit.
# Uncommitted changes count too. Without --all, no source is begun after 45 seconds, and a message gives the
# number of omitted ones.
set -eu
cd "$(dirname "$0")/.."
tidy=""
for candidate in clang-tidy-19 clang-tidy; do
  if [[ $("$candidate" --version 2>/dev/null) == *"version 19."* ]]; then tidy=$candidate; break; fi
done
if [[ -z $tidy ]]; then
  echo "tidy: no clang-tidy 19 here, so it is not run. On Debian or Ubuntu: apt-get install clang-tidy-19" >&2
  exit 0
fi

# Prints the changed sources; for a header, the source of the same name.
changed_sources() {
  local base=$1 file
  if [[ -z $base ]]; then
    base=$(git merge-base HEAD main 2>/dev/null || git rev-parse HEAD)
    if [[ $base == "$(git rev-parse HEAD)" ]]; then base=$(git rev-parse -q --verify HEAD~1 || echo "$base"); fi
  fi
  { git diff --name-only --diff-filter=d "$base" -- host bench; git ls-files --others --exclude-standard host bench; } |
    while read -r file; do
      case $file in
        *.cpp) echo "$file" ;;
        *.h) if [[ -e ${file%.h}.cpp ]]; then echo "${file%.h}.cpp"; fi ;;
      esac
    done | sort -u
}

limit=45
if [[ ${1:-} == --all ]]; then
  limit=100000
  mapfile -t sources < <(find host bench -name '*.cpp' | sort)
elif git rev-parse --git-dir >/dev/null 2>&1; then
  mapfile -t sources < <(changed_sources "${1:-}")
else
  echo "tidy: no git checkout here, so nothing counts as changed (--all: every file)" >&2
  exit 0
fi
if [[ ${#sources[@]} == 0 ]]; then exit 0; fi

# A build folder that is configured but never built, for the compile command of each source on its own.
cmake --preset release -B build/tidy -DSUNDOG_UNITY=OFF -DSUNDOG_UNITY_TESTS=OFF >build/tidy.log 2>&1 || { cat build/tidy.log >&2; exit 1; }
sources_known=$(grep -o '"file": "[^"]*"' build/tidy/compile_commands.json | sed "s|.*\"$PWD/||; s|\"||")
checked=()
for source in "${sources[@]}"; do
  if grep -qxF "$source" <<<"$sources_known"; then checked+=("$source"); fi  # others need libraries that are missing here
done
if [[ ${#checked[@]} == 0 ]]; then exit 0; fi
left=$(mktemp)
trap 'rm -f "$left"' EXIT
export began=$(date +%s) limit tidy left
status=0
printf '%s\n' "${checked[@]}" | xargs -P "$(nproc)" -I{} bash -c '
  if (($(date +%s) - began >= limit)); then echo "$1" >>"$left"; exit 0; fi
  "$tidy" -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option "$1" 2> >(grep -v "warnings\? generated" >&2) || exit 1
  ! "${tidy/tidy/query}" -p build/tidy -f tests/code_rules.query "$1" | grep "^/.*binds here"' _ {} || status=1
if [[ -s $left ]]; then
  echo "tidy: $(wc -l <"$left") of ${#checked[@]} changed sources were left out after $limit seconds (tests/tidy.sh --all: every source)" >&2
fi
if [[ $status != 0 ]]; then echo "tidy: see above" >&2; fi
exit $status
