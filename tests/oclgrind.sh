#!/usr/bin/env bash
# Runs a command under Oclgrind and fails if Oclgrind reports anything: an access out of bounds, a data race, a
# use of uninitialised memory, a wrong API call. Oclgrind's own exit status is the command's, so its log decides.
#   tests/oclgrind.sh build/release/sundog render scenes/spheres.json --size 16x16 -o out.png
# --defined-or-not as the first argument turns off the check of uninitialised memory, which crashes in some
# kernels.
set -u
uninitialized=--uninitialized
if [ "${1-}" = --defined-or-not ]; then uninitialized=; shift; fi
[ $# -gt 0 ] || { echo "usage: $0 COMMAND [ARGUMENT]..." >&2; exit 2; }
command -v oclgrind >/dev/null || { echo "oclgrind.sh: no oclgrind. On Debian or Ubuntu: apt-get install oclgrind" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# -cl-opt-disable: Oclgrind's optimiser emits calls that its interpreter lacks. Without the kernel cache,
# messages have source lines.
SUNDOG_KERNEL_CACHE=off oclgrind --build-options -cl-opt-disable --check-api --data-races $uninitialized \
  --max-errors 20 --log "$work/log" "$@" 2> >(tee "$work/stderr" >&2)
status=$?
wait
if [ -s "$work/log" ]; then
  echo "oclgrind.sh: Oclgrind found, in: $*" >&2
  cat "$work/log" >&2
  exit 1
fi
if grep -q "OCLGRIND FATAL ERROR" "$work/stderr"; then
  echo "oclgrind.sh: Oclgrind could not run: $*" >&2
  exit 1
fi
exit $status
