#!/bin/bash
# All C++ and OpenCL C of the project as .clang-format has it. clang-format 19 is the measure: other versions set some lines
# otherwise, so without it nothing is compared and a message says so.
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
# Catch2 2 never ends the report of a failure whose name has ": " so late.
if grep -rnE --include=*.cpp '(TEST_CASE|SECTION)\("[^"]{60,}: ' tests; then
  echo "check_format: name the test without a colon" >&2
  exit 1
fi
# Names that one version of Catch2 alone has; support/catch.h has one for both.
if grep -rnE --include=*.cpp --include=*.h 'Catch::(Contains|StartsWith|EndsWith|Matches|Equals|Matchers::Contains)\b' tests |
  grep -v '^tests/support/catch.h:'; then
  echo "check_format: Catch2 3 has Catch::Matchers::StartsWith and the like, and ContainsSubstring for Contains" >&2
  exit 1
fi
