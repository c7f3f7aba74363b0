#!/usr/bin/env bash
# Every kernel file through clang as OpenCL C 1.2, warnings as errors. Unused parameters are allowed: the scene's tables are passed
# in bundles (kernels/lib/tables.h).
set -eu
cd "$(dirname "$0")/.."
clang=$(command -v clang || ls /usr/bin/clang-[0-9]* 2>/dev/null | sort -V | tail -n 1 || true)
[ -n "$clang" ] || { echo "lint_kernels: no clang. On Debian or Ubuntu: apt-get install clang" >&2; exit 1; }
failed=0
for lanes in "-DTILE_W=4 -DTILE_H=4" "-DTILE_W=4 -DTILE_H=4 -DSUNDOG_PORTABLE" "-DTILE_W=1 -DTILE_H=1 -DWIDE_VECTORS=0" "-DTILE_W=1 -DTILE_H=1 -DHAS_MEDIA=0 -DHAS_SHADOW_FILTERS=0 -DHAS_SECONDARY=0 -DHAS_SDF=0 -DSUNDOG_PORTABLE"; do
  for file in kernels/lib/*.cl kernels/lib/*/*.cl kernels/entry/*.cl; do
    unused=""; case "$file" in kernels/lib/*) unused=-Wno-unused-function ;; esac  # a library file alone uses nothing
    # shellcheck disable=SC2086
    "$clang" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Wno-unused-parameter $unused -Werror \
      $lanes -Ikernels "$file" || failed=1
  done
done
exit $failed
