#!/usr/bin/env bash
# Every kernel file through clang as OpenCL C 1.2, warnings as errors, with all features of a scene and with few. Unused parameters
# are allowed: what a feature needs stays in the signature without it.
set -eu
cd "$(dirname "$0")/.."
clang=$(command -v clang || ls /usr/bin/clang-[0-9]* 2>/dev/null | sort -V | tail -n 1 || true)
[ -n "$clang" ] || { echo "lint_kernels: no clang. On Debian or Ubuntu: apt-get install clang" >&2; exit 1; }
features=$(grep -o 'FEATURE([a-z0-9]*, [A-Z_]*' kernels/shared/features.h | sed 's/.*, //')
shapes=""; all="-DHAS_SDF=1"; few="-DHAS_SDF=0"
solids=$(grep -o '^ *SOLID([A-Z]*' kernels/shared/shapes.h | sed 's/.*(//')
for shape in MESH $solids BVH; do shapes+=" -DHAS_$shape=1"; done
for feature in $features; do all+=" -D$feature=1"; few+=" -D$feature=0"; done
all+=$shapes; few+=$shapes
failed=0
for lanes in "-DTILE_W=4 -DTILE_H=4 $all" "-DTILE_W=4 -DTILE_H=4 -DSUNDOG_PORTABLE $all" "-DTILE_W=1 -DTILE_H=1 -DWIDE_VECTORS=0 $all" \
  "-DTILE_W=4 -DTILE_H=4 $few" "-DTILE_W=1 -DTILE_H=1 -DSUNDOG_PORTABLE $few"; do
  for file in kernels/lib/*/*.cl kernels/entry/*.cl; do
    unused=""; case "$file" in kernels/lib/*) unused=-Wno-unused-function ;; esac  # a library file alone uses nothing
    # shellcheck disable=SC2086
    "$clang" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Wno-unused-parameter $unused -Werror \
      $lanes -Ikernels "$file" || failed=1
  done
done
exit $failed
