#!/bin/bash
# Compares two builds of sundog: pictures and ray counts to the bit, then speed. See --help.
set -u
usage() {
  cat <<'END'
usage: bench/same_pictures.sh [OPTIONS] OLD_BUILD NEW_BUILD

Renders scenes with two builds and compares pictures, AOVs and ray counts to the bit, then times both in turn.
OLD_BUILD and NEW_BUILD are build folders (build/release) or `sundog` programs; each uses its own kernels.

Before a change: build, and keep the program:  cp build/release/sundog /tmp/sundog_before
After it:                                      bench/same_pictures.sh /tmp/sundog_before build/release

  --scenes FILE,...    scenes or models (default: scenes/*.json and bench/scenes/*.json)
  --devices SPEC,...   devices as `sundog --device` has them (default: each that `sundog devices` lists);
                       `llvmpipe` makes Mesa offer its device. One that is not there is skipped.
  --oclgrind           four scenes under Oclgrind too, in 16x16 pixels
  --set POINTER=VALUE  change the scenes, for both builds, as in /render/tracer=compact; repeatable
  --size WxH           size of the pictures that are compared (default 96x72)
  --repeat N           timed pairs (default 5)
  --time-size WxH      size of the timed pictures (default: --size times 1 to 6, so that a frame takes about 0.1 s)
  --no-times           only compare
  --keep FOLDER        keep the pictures and statistics there

The times are those of the kernels. The ratio is the median over the pairs of NEW's time by OLD's, with the least and the
greatest: below 1 NEW is faster. The first run compiles each scene's kernels, for which the kernel cache is used.
Exit status: 0 the same, 6 something differs, 2 wrong usage, 1 nothing could be compared.
END
}

root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*/*}
scenes=() devices=() common=() builds=()
oclgrind='' size=96x72 repeat=5 time_size='' times=1 keep=''

fail() { echo "same_pictures.sh: $*" >&2; exit 2; }
say() { echo "same_pictures.sh: $*" >&2; }

while [[ $# -gt 0 ]]; do
  case $1 in
    --help | -h) usage; exit 0 ;;
    --oclgrind) oclgrind=1 ;;
    --no-times) times='' ;;
    --scenes | --devices | --set | --size | --repeat | --time-size | --keep)
      [[ $# -gt 1 ]] || fail "$1: wanted a value"
      case $1 in
        --scenes) IFS=, read -ra scenes <<<"$2" ;;
        --devices) IFS=, read -ra devices <<<"$2" ;;
        --set) common+=(--set "$2") ;;
        --size) size=$2 ;;
        --repeat) repeat=$2 ;;
        --time-size) time_size=$2 ;;
        --keep) keep=$2 ;;
      esac
      shift ;;
    -*) fail "$1: unknown option (--help lists them)" ;;
    *) builds+=("$1") ;;
  esac
  shift
done
[[ ${#builds[@]} == 2 ]] || fail "wanted two builds, found ${#builds[@]} (--help says how to use it)"
[[ $size =~ ^[0-9]+x[0-9]+$ ]] || fail "--size $size: wanted WxH"
[[ -z $time_size || $time_size =~ ^[0-9]+x[0-9]+$ ]] || fail "--time-size $time_size: wanted WxH"
[[ $repeat =~ ^[1-9][0-9]*$ ]] || fail "--repeat $repeat: wanted a number from 1"

# program BUILD: prints the path of the build's sundog.
program() {
  local found=$1
  [[ -d $found ]] && found=$found/sundog
  [[ -f $found && -x $found ]] || fail "$1: neither a build folder with a sundog in it nor a program"
  readlink -f -- "$found"
}
old=$(program "${builds[0]}") || exit 2
new=$(program "${builds[1]}") || exit 2
unset SUNDOG_KERNEL_DIR SUNDOG_DEVICE
[[ ${#scenes[@]} -gt 0 ]] || for scene in "$root"/scenes/*.json "$root"/bench/scenes/*.json; do
  [[ $scene == *.schema.json ]] || scenes+=("$scene")
done

if [[ " ${devices[*]} " == *llvmpipe* ]]; then export RUSTICL_ENABLE=${RUSTICL_ENABLE:-llvmpipe}; fi
if [[ ${#devices[@]} == 0 ]]; then
  mapfile -t devices < <("$new" devices | sed -n 's/^  \([0-9]*:[0-9]*\) \([^ -]*\).*/\1|\2/p')
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [[ $keep ]]; then mkdir -p -- "$keep" || exit 2; keep=$(readlink -f -- "$keep"); else keep=$work; fi

aovs_of() { "$1" render --help | tr '\n' ' ' | sed -n 's/.*an extra image in the .exr: \([a-z_, ]*\);.*/\1/p' | tr -d ' ' | tr , '\n' | sort; }
aovs=() parts=()  # without the variance, which only frames in passes have; only paths have parts of light
for aov in $(comm -12 <(aovs_of "$old") <(aovs_of "$new")); do
  case $aov in
    variance) ;;
    *_direct | *_indirect | emission | sky) parts+=(--aov "$aov") ;;
    *) aovs+=(--aov "$aov") ;;
  esac
done

name_of() {
  local name
  name=$(basename -- "$1" .json)
  [[ $1 == *bench/scenes/* ]] && name=bench_$name
  echo "$name"
}

# render PROGRAM SCENE DEVICE SIZE NAME ARGUMENT...: writes NAME.exr, NAME.json and NAME.log to the folder
# $keep.
render() {
  local program=$1 scene=$2 device=$3 wanted=$4 name=$keep/$5
  shift 5
  local under=() place=(--device "$device")
  if [[ $device == oclgrind ]]; then under=(oclgrind --build-options -cl-opt-disable) place=(--max-depth 4); fi
  rm -f "$name.exr" "$name.json"
  timeout 900 "${under[@]}" "$program" render "$scene" "${place[@]}" --size "$wanted" --samples 1 \
    "${common[@]}" "$@" --float -o "$name.exr" --stats "$name.json" -q >"$name.log" 2>&1
}

# section NAME FILE: prints an object of the statistics as "key value" lines.
section() { awk -v name="\"$1\":" '$1 == name { on = 1; next } on && /}/ { exit } on { gsub(/[",:]/, ""); print $1, $2 }' "$2" | sort; }
counts() { section rays "$1"; section counters "$1"; }
kernel_ms() { awk '/"device_ms":/ { d = $2 + 0 } /"host_ms":/ { h = $2 + 0; sum += d > 0 ? d : h } END { printf "%.4f", sum }' "$1"; }
median() { sort -g | awk '{ v[NR] = $1 } END { printf "%.4f", NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }
reason() { grep -v warning "$keep/$1.log" | tail -n 1 | cut -c -200; }

# difference NAME: prints how NAME_old and NAME_new differ; nothing if they are equal.
difference() {
  local a=$keep/$1_old b=$keep/$1_new text=() shown
  if ! cmp -s "$a.exr" "$b.exr"; then
    shown=$("$new" compare --tolerance 0 --json "$a.exr" "$b.exr" 2>"$work/compare.log")
    case $? in
      0) ;;  # the headers differ
      6) text+=("$(awk '/"differing":/ && !n++ { d = $2 + 0 } /"max":/ { m = $2 + 0 } /"pixels":/ { p = $2 + 0 }
           END { if (d) printf "pictures differ: %d of %d pixels, at most %g", d, p, m; else print "AOVs differ" }' <<<"$shown")") ;;
      *) text+=("pictures cannot be compared: $(tail -n 1 "$work/compare.log")") ;;
    esac
  fi
  text+=("$(join <(counts "$a.json") <(counts "$b.json") | awk '$2 != $3 { printf "%s%s %s became %s", sep, $1, $2, $3; sep = ", " }')")
  [[ $(join <(counts "$a.json") <(counts "$b.json") | wc -l) -ge 4 ]] || text+=("no ray counts")
  printf '%s\n' "${text[@]}" | sed '/^$/d' | paste -sd ';' | sed 's/;/; /g'
}

same=0 differ=0 skipped=0 timed=()
tell() { printf '%-26s %-12s %s\n' "$scene_name" "$label" "$*"; }

# compare_builds SCENE DEVICE SIZE: renders with both builds at once and prints the result.
compare_builds() {
  local scene=$1 device=$2 wanted=$3 name of_old of_new found more=()
  if grep -qE '"integrator": *"path"' "$scene"; then more=("${parts[@]}"); fi
  name=${scene_name}_${label//[^a-zA-Z0-9]/_}
  render "$old" "$scene" "$device" "$wanted" "${name}_old" "${aovs[@]}" "${more[@]}" & local one=$!
  render "$new" "$scene" "$device" "$wanted" "${name}_new" "${aovs[@]}" "${more[@]}" & local two=$!
  wait "$one"; of_old=$?
  wait "$two"; of_new=$?
  if [[ $of_old != 0 && $of_new == 0 ]]; then
    tell "only the new build renders it: $(reason "${name}_old")"; skipped=$((skipped + 1))
  elif [[ $of_new != 0 && $of_old == 0 ]]; then
    tell "DIFFERS: the new build fails (status $of_new): $(reason "${name}_new")"; differ=$((differ + 1))
  elif [[ $of_new != 0 ]]; then
    tell "neither build renders it: $(reason "${name}_new")"; skipped=$((skipped + 1))
  else
    found=$(difference "$name")
    if [[ $found ]]; then tell "DIFFERS: $found"; differ=$((differ + 1)); else tell "the same"; same=$((same + 1)); fi
    [[ $device == oclgrind ]] || timed+=("$scene|$device|$label")
  fi
}

# is_there SPEC: whether both builds find the device.
is_there() {
  printf '{"camera": {"position": [0, 0, 3], "target": [0, 0, 0]}, "materials": {"m": {}}, "objects": []}' >"$work/none.json"
  local program
  for program in "$old" "$new"; do
    timeout 100 "$program" render "$work/none.json" --device "$1" --size 4x4 -q -o "$work/none.png" 2>&1 | grep -q "no such device" &&
      return 1
  done
  return 0
}

for entry in "${devices[@]}"; do
  device=${entry%%|*} label=${entry##*|}
  if ! is_there "$device"; then say "skipped: there is no device $device here"; continue; fi
  for scene in "${scenes[@]}"; do
    scene_name=$(name_of "$scene")
    compare_builds "$scene" "$device" "$size"
  done
done
if [[ $oclgrind ]] && ! command -v oclgrind >/dev/null; then
  say "skipped: there is no oclgrind here (apt-get install oclgrind)"
elif [[ $oclgrind ]]; then
  label=oclgrind
  for scene_name in spheres nested_glass hollow_ice julia; do compare_builds "$root/scenes/$scene_name.json" oclgrind 16x16; done
fi
echo "$same the same, $differ differ, $skipped not compared"

# size_for SCENE DEVICE: prints --size times a whole number (1 to 6), for a frame of about 100 ms. The first
# frame only loads the kernels.
size_for() {
  render "$old" "$1" "$2" "$size" pilot && render "$new" "$1" "$2" "$size" pilot && render "$old" "$1" "$2" "$size" pilot || return
  awk -v size="$size" -v ms="$(kernel_ms "$keep/pilot.json")" 'BEGIN {
    split(size, s, "x"); f = int(sqrt(100 / (ms > 0 ? ms : 1))); f = f < 1 ? 1 : f > 6 ? 6 : f; print s[1] * f "x" s[2] * f }'
}

# time_builds SCENE DEVICE SIZE: prints a line of the table.
time_builds() {
  local i order which pair=() ratios=$work/ratios
  : >"$work/old" && : >"$work/new" && : >"$ratios"
  for ((i = 0; i < repeat; ++i)); do
    order="old new"
    ((i % 2)) && order="new old"
    for which in $order; do
      render "${!which}" "$1" "$2" "$3" "time_$which" || return
      kernel_ms "$keep/time_$which.json" >>"$work/$which"
      echo >>"$work/$which"
    done
  done
  paste "$work/old" "$work/new" | awk '{ printf "%.4f\n", $2 / ($1 > 0 ? $1 : 1e-9) }' >"$ratios"
  mapfile -t pair < <(sort -g "$ratios")
  local middle
  middle=$(median <"$ratios")
  printf '%-26s %-12s %9s %10.2f %10.2f  %6.3f  %.3f..%.3f\n' "$scene_name" "$label" "$3" "$(median <"$work/old")" \
    "$(median <"$work/new")" "$middle" "${pair[0]}" "${pair[-1]}"
  echo "$middle" >>"$work/medians_$label"
}

if [[ $times && ${#timed[@]} -gt 0 ]]; then
  kept_results=("${XDG_CACHE_HOME:-$HOME/.cache}"/sundog/tuning/*.json)
  [[ -e ${kept_results[0]} ]] && say "results of \`sundog tune\` are kept here; a build whose kernels they are for uses them"
  printf '\n%-26s %-12s %9s %10s %10s  %6s  %s\n' scene device size "old ms" "new ms" new/old "range of $repeat pairs"
  for entry in "${timed[@]}"; do
    IFS='|' read -r scene device label <<<"$entry"
    scene_name=$(name_of "$scene")
    time_builds "$scene" "$device" "${time_size:-$(size_for "$scene" "$device")}"
  done
  for file in "$work"/medians_*; do
    [[ -s $file ]] && awk -v of="${file##*_}" '{ s += log($1) } END { printf "%-26s %-12s %9s %10s %10s  %6.3f\n", "geometric mean", of, "", "", "", exp(s / NR) }' "$file"
  done
fi
[[ $differ == 0 ]] || exit 6
[[ $same -gt 0 ]] || exit 1
