#!/bin/bash
# Checks that all C++ and OpenCL C is formatted by .clang-format. Other versions than clang-format 19 format
# some lines differently, so without version 19 it prints a message and checks nothing.
set -eu
cd "$(dirname "$0")/.."
format=""
for candidate in clang-format-19 clang-format; do
  if [[ $("$candidate" --version 2>/dev/null) == *"version 19."* ]]; then format=$candidate; break; fi
done
if [[ -z $format ]]; then
  echo "check_format: no clang-format 19 here, so the format is not checked. On Debian or Ubuntu: apt-get install clang-format-19" >&2
  exit 0
fi
find host include examples python kernels tests bench -name '*.cpp' -o -name '*.h' -o -name '*.hpp' -o -name '*.c' -o -name '*.cl' | sort | xargs -P "$(nproc)" -n 100 "$format" --dry-run -Werror || {
  echo "check_format: mend it with: $format -i FILE..." >&2
  exit 1
}
