#!/usr/bin/env bash
# Compiles every kernel file with clang as OpenCL C 1.2, warnings as errors: with all features of a scene and
# with few, then both integrators with random features, as scenes may combine them. Unused parameters are
# allowed, because a feature's parameters stay in the signature without it. Entries must also obey
# tests/kernel_rules.query; --rules checks only that.
#   tests/lint_kernels.sh [--rules] [COMBINATIONS [SEED]]
# Defaults: 24 combinations, seed 1. SUNDOG: the program (default build/release/sundog).
set -eu
cd "$(dirname "$0")/.."
clang=$(command -v clang || ls /usr/bin/clang-[0-9]* 2>/dev/null | sort -V | tail -n 1 || true)
[ -n "$clang" ] || { echo "lint_kernels: no clang. On Debian or Ubuntu: apt-get install clang" >&2; exit 77; }
features=$(grep -ho 'FEATURE([a-z0-9]*, [A-Z_]*' kernels/shared/{features,lobes}.h | sed 's/.*, //')
shapes=""; all="-DHAS_SDF=1"; few="-DHAS_SDF=0"
solids=$(grep -o '^ *SOLID([A-Z]*' kernels/shared/shapes.h | sed 's/.*(//')
for shape in MESH $solids BVH; do shapes+=" -DHAS_$shape=1"; done
for feature in $features; do all+=" -D$feature=1"; few+=" -D$feature=0"; done
all+="$shapes -DHAS_MATTES=1 -DHAS_LIGHT_PARTS=1"; few+=$shapes
rules=""; if [ "${1:-}" = --rules ]; then rules=$1; shift; fi
failed=0
# Plain files are checked as converted to lanes.
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
for file in $(cd kernels && find plain -name '*.cl'); do
  mkdir -p "$made/${file%/*}"
  SUNDOG_KERNEL_DIR=$PWD/kernels "${SUNDOG:-build/release/sundog}" kernels "$file" --lines >"$made/$file"
done
opencl="-x cl -cl-std=CL1.2 -Xclang -finclude-default-header -I$made -Ikernels"

query=$(ls /usr/bin/clang-query* 2>/dev/null | sort -V | tail -n 1)
[ -n "$query" ] || { echo "lint_kernels: no clang-query. On Debian or Ubuntu: apt-get install clang-tools-19" >&2; exit 77; }
faults() {  # FILE OPTION...
  # shellcheck disable=SC2086
  ! "$query" -f tests/kernel_rules.query "$1" -- $opencl "${@:2}" 2>&1 | grep -A1 "binds here\|error:"
}
cat >"$made/forms.cl" <<'END'
typedef struct P { float t, all[4]; float4 v; } P;
int set(P* p); int get(const P* p); int fill(float* all); float sum(const float* all);
void whole(P p, P q) { p = q; }                         // writes
void member(P p) { p.t = 1; }                           // writes
void component(P p) { p.v.x += 1; }                     // writes
void lane(P p) { ((float*)&p.v)[1] = 1; }               // writes
void element(P p) { p.all[1]++; }                       // writes
void handed_on(P p) { set(&p); }                        // writes
void part_handed_on(P p) { fill(p.all); }               // writes
float in_an_index(P p, P* to) { return to->all[(int)p.t++] + to->all[get(to)]; }  // writes
void pointed_at(P p) { P* q = &p; }                     // writes
P read(P p, P* to) { P q = p; q.t = get(&p) + sum(p.all); to->all[(int)p.t] = ((float*)&p.v)[1] == p.v.x; return p; }
END
diff <(grep -n '// writes' "$made/forms.cl" | cut -d: -f1) <(faults "$made/forms.cl" | grep -o 'forms.cl:[0-9]*' | cut -d: -f2) >&2 || failed=1

check() {  # FILE OPTION...
  # shellcheck disable=SC2086
  [ -n "$rules" ] || "$clang" $opencl -fsyntax-only -Wall -Wextra -Wno-unused-parameter -Wno-pragma-once-outside-header -Werror "${@:2}" "$1" || failed=1
  case $1 in kernels/entry/*) faults "$@" || failed=1 ;; esac
}
for lanes in "-DTILE_W=4 -DTILE_H=4 $all" "-DTILE_W=4 -DTILE_H=4 -DSUNDOG_PORTABLE $all" "-DTILE_W=1 -DTILE_H=1 -DLANES=1 -DWIDE_VECTORS=0 $all" \
  "-DTILE_W=4 -DTILE_H=4 $few -UHAS_AREA_LIGHTS -DHAS_AREA_LIGHTS=1" "-DTILE_W=1 -DTILE_H=1 -DLANES=1 -DSUNDOG_PORTABLE $few"; do
  for file in kernels/lib/*/*.cl kernels/entry/*.cl; do
    unused=""; case "$file" in kernels/lib/*) unused=-Wno-unused-function ;; esac  # a library file does not use all its functions
    # shellcheck disable=SC2086
    check "$file" $unused $lanes
  done
done

# Pairs FEATURE:IMPLIED, ordered so that one pass over the list is enough.
brings="PARALLAX:RELIEF RELIEF:MAPS RELIEF:UV METAL_ROUGH:MAPS METAL_ROUGH:HIGHLIGHTS COAT_MAPS:LAYER_MAPS FUZZ_MAPS:LAYER_MAPS LAYER_MAPS:MAPS LAYER_MAPS:LAYERS TEXEL_PAGES:MAPS TURNS:OBJECT_MOTION ENVIRONMENT:AREA_LIGHTS
  LIGHT_TREE:AREA_LIGHTS ROUGH_GLASS:ROUGH ROUGH:SECONDARY SHADOW_FILTERS:SECONDARY ABSORPTION:MEDIA SCATTERING:MEDIA TOUCHING:MEDIA
  DISPERSION:MEDIA GLOW:SDF SIDES:SDF OCCLUSION:SDF SOFT_SHADOWS:SDF MESH:BVH"
of_paths="DISPERSION SCATTERING GUIDES CAUSTICS"  # Whitted's integrator does not have them
lanes=("-DTILE_W=4 -DTILE_H=4" "-DTILE_W=4 -DTILE_H=4 -DSUNDOG_PORTABLE" "-DTILE_W=1 -DTILE_H=1 -DLANES=1 -DSUNDOG_PORTABLE"
  "-DTILE_W=1 -DTILE_H=1 -DLANES=1 -DWIDE_VECTORS=0")
RANDOM=${2:-1}
for ((i = 0; i < ${1:-24}; ++i)); do
  unset has; declare -A has
  for feature in SDF MESH $solids BVH $(grep -ho 'FEATURE(bool, HAS_[A-Z_]*' kernels/shared/{features,lobes}.h | sed 's/.*HAS_//'); do
    has[$feature]=$((RANDOM % 5 < 2))
  done
  for pair in $brings; do [ "${has[${pair%:*}]}" = 0 ] || has[${pair#*:}]=1; done
  maps=${has[MAPS]}
  numbers="-DSAMPLER=$((RANDOM % 6)) -DSAMPLE_ROOM=4 -DTEXTURE_MAPPINGS=$((maps * (RANDOM % 256))) -DTEXTURE_KINDS=$((maps * RANDOM)) -DMAP_SLOTS_USED=$((maps * 4 * RANDOM))
    -DTEXTURE_STACK=$((maps * (RANDOM % 4))) -DTEXEL_FORMATS=$((maps * (RANDOM % 16))) -DEXTRA_UVS=$((has[UV] * (RANDOM % 2)))
    -DSDF_TWO_SIDED=$((has[SDF] * (RANDOM % 2))) -DSDF_FLAGS=$((has[SDF] * (RANDOM % 4)))"
  options=""
  for feature in "${!has[@]}"; do options+=" -DHAS_$feature=${has[$feature]}"; done
  options+=" -DHAS_MATTES=$((i / 4 % 2)) -DHAS_LIGHT_PARTS=$((i / 4 % 2)) -DHAS_LIGHT_GROUPS=$((i / 4 % 4 == 2))"
  for entry in whitted path; do
    without=""
    if [ $entry = whitted ]; then for feature in $of_paths; do without+=" -UHAS_$feature -DHAS_$feature=0"; done; fi
    # shellcheck disable=SC2086
    check kernels/entry/render_$entry.cl -Wno-unused-function $options $without $numbers ${lanes[i % 4]}
  done
done
exit $failed
