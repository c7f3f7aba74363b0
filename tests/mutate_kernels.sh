#!/bin/bash
# Mutation test: changes kernels and reports the changes that no test notices. See --help.
set -u
usage() {
  cat <<'END'
usage: tests/mutate_kernels.sh [OPTIONS] [BUILD]

Makes the changes of tests/kernel_changes.txt, one at a time, in a copy of the kernels, and runs the device tests
of BUILD (default: build/release) with it: first those that the change names, then all. Nothing is rebuilt.

  --only WORD      only changes whose file or description contains WORD
  --quick          only the tests that a change names
  --skip I/N       only every N-th change, from the I-th (1 to N): for several runs side by side
  --devices SPEC   devices of the tests, as SUNDOG_TEST_DEVICES (default: portable, which is PoCL)
  --limit SECONDS  for each run of tests (default 300); one that takes longer has noticed
  --check          only see that each change fits its file

A line for each change: noticed, NOT NOTICED, harmless (not noticed, and the list says why), MISJUDGED (noticed, though
the list calls it harmless), DOES NOT BUILD or NO SUCH TEST. Exit status: 0 when all are noticed or harmless, else 6; 2 wrong usage.
END
}

cd "$(dirname "$0")/.." || exit 2
root=$PWD build=build/release only="" quick=0 part=1 parts=1 devices=portable limit=300 check=0
while [ $# -gt 0 ]; do
  case $1 in
    --help) usage; exit 0 ;;
    --only) only=$2; shift ;;
    --quick) quick=1 ;;
    --skip) part=${2%/*} parts=${2#*/}; shift ;;
    --devices) devices=$2; shift ;;
    --limit) limit=$2; shift ;;
    --check) check=1 ;;
    -*) usage >&2; exit 2 ;;
    *) build=$1 ;;
  esac
  shift
done
tests=$build/tests/device_tests
[ "$check" = 1 ] || [ -x "$tests" ] || { echo "mutate_kernels: no $tests: build it first" >&2; exit 2; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export SUNDOG_KERNEL_DIR=$folder/kernels XDG_CACHE_HOME=$folder/cache SUNDOG_TEST_DEVICES=$devices
cp -r kernels "$SUNDOG_KERNEL_DIR"

# passes TESTS: runs them, with their output in $folder/out. Status 0: they pass; 1: they fail; 2: a kernel
# does not build; 3: there are no such tests.
passes() {
  timeout "$limit" "$tests" -\# --abort "$1" > "$folder/out" 2>&1
  local status=$?
  grep -q "No test cases matched\|No tests ran" "$folder/out" && return 3
  [ $status = 0 ] && return 0
  grep -q "did not build on" "$folder/out" && return 2
  return 1
}

done_count=0 noticed=0 bad=0 number=0

# Makes the change, runs the tests and reports the result.
try_change() {
  local text rest result
  text=$(cat "$root/kernels/$file"; echo .)
  text=${text%.} rest=${text#*"$old"}
  if [ "$rest" = "$text" ] || [ "${rest#*"$old"}" != "$rest" ]; then
    echo "DOES NOT FIT   $file: $what: its text is not there exactly once"
    bad=$((bad + 1))
    return
  fi
  [ "$check" = 1 ] && return
  printf '%s' "${text%%"$old"*}$new$rest" > "$SUNDOG_KERNEL_DIR/$file"
  passes "$named"
  result=$?
  if [ $result = 0 ] && [ $quick = 0 ] && [ -z "$harmless" ]; then
    passes '~[.]'
    result=$?
  fi
  cp "$root/kernels/$file" "$SUNDOG_KERNEL_DIR/$file"
  case $result in
    0) if [ -n "$harmless" ]; then result=harmless; else result="NOT NOTICED" bad=$((bad + 1)); fi ;;
    2) result="DOES NOT BUILD" bad=$((bad + 1)) ;;
    3) result="NO SUCH TEST" bad=$((bad + 1)) ;;
    *) if [ -n "$harmless" ]; then result=MISJUDGED bad=$((bad + 1)); else result=noticed noticed=$((noticed + 1)); fi ;;
  esac
  printf '%-14s %s: %s\n' "$result" "$file" "$what"
}

# Tries the change that has been read, if the options select it.
finish_change() {
  [ -n "$file" ] || return
  number=$((number + 1))
  if [ $(((number - part) % parts)) = 0 ] && { [ -z "$only" ] || [[ "$file $what" == *"$only"* ]]; }; then
    done_count=$((done_count + 1))
    try_change
  fi
  file=""
}

# Unchanged kernels must pass; otherwise the results mean nothing.
check_unchanged() {
  passes "$(sed -n 's/^tests: //p' "$root/tests/kernel_changes.txt" | sort -u | paste -sd,)" && return
  echo "mutate_kernels: tests fail without a change:" >&2
  tail -n 30 "$folder/out" >&2
  exit 1
}
[ $check = 1 ] || [ -n "$only" ] || [ "$part" != 1 ] || limit=3000 check_unchanged

file=""
while IFS= read -r line || [ -n "$line" ]; do
  case $line in
    "## "*) finish_change; line=${line#\#\# }; file=${line%%: *} what=${line#*: } old="" new="" named="" harmless="" ;;
    "tests: "*) named=${line#tests: } ;;
    "harmless: "*) harmless=${line#harmless: } ;;
    "- "*) old+=${old:+$'\n'}${line#- } ;;
    "+ "* | "+") line=${line#+}; new+=${new:+$'\n'}${line# } ;;
  esac
done < "$root/tests/kernel_changes.txt"
finish_change
if [ $check = 1 ]; then
  echo "$((done_count - bad)) of $done_count changes fit"
else
  echo "$done_count changes of $number, $noticed noticed"
fi
[ $bad = 0 ] || exit 6
