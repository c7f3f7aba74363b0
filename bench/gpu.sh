#!/bin/bash
# Measures sundog on one device, usually a GPU, with one command in eight minutes:
#   bench/gpu.sh [--device SPEC] [--seconds N] [--quick] OUT_DIR [MODEL...]
# From a clone it runs build/release/sundog (or the folder SUNDOG_BUILD), from a bundle the bundle's program.
# The parts, in order:
#   the devices; `sundog check`; every scene in 64x64 against the bundle's pictures (a clone has none)
#   builds of six scenes (cold, warm); registers, memory and build logs of each of their kernels
#   `bench rays` of three models, or of MODEL..., with each node loop (kernels/lib/trace/single.cl: NODE_LOOP),
#   on NVIDIA devices also with 64 registers
#   samples a second of the six scenes; times by work-group size; the roofline
#   watts and joules if nvidia-smi reads them; Embree and tinybvh if they were built
# Each part writes a table (.txt), figures (.json) and messages (.log) to OUT_DIR as soon as it is done, and
# summary.txt lists it. A part that fails does not stop the others; parts that would begin after N seconds
# (480) are left out. The default SPEC is `gpu`. --quick: tiny settings, to test that everything runs.
set -u
root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*/*}
programs=${SUNDOG_BUILD:-$root/build/release}
[[ -x $root/bin/sundog && -x $root/sundog ]] && programs=$root
sundog=$programs/sundog
device=gpu
seconds=480
quick=
while [[ ${1-} == --* ]]; do
  case $1 in
    --device) device=${2:?--device: wanted a SPEC}; shift 2 ;;
    --seconds) seconds=${2:?--seconds: wanted a number}; shift 2 ;;
    --quick) quick=1; shift ;;
    *) echo "gpu.sh: $1: wanted --device SPEC, --seconds N or --quick" >&2; exit 2 ;;
  esac
done
if [[ $# -lt 1 ]]; then
  echo "usage: gpu.sh [--device SPEC] [--seconds N] [--quick] OUT_DIR [MODEL...]" >&2
  exit 2
fi
out=$1
shift
mkdir -p -- "$out/build_logs" || exit 1
out=$(readlink -f -- "$out")
scenes=$root/scenes
models=("$@")
[[ $# -gt 0 ]] || models=("$scenes"/sundog/spruce_{needles,snow}.obj "$scenes/relief/ball.obj")
frame_scenes=(spheres hollow_ice mandelbulb cornell_path glass_path frosted_panes)
frame_size=1024x1024
small=64x64 bench=() rays=(--rays 1024) groups=() roof=()
if [[ $quick ]]; then
  frame_scenes=(spheres cornell_path)
  frame_size=16x16
  small=8x8 bench=(--repeat 1) rays=(--rays 32) groups=(--rays 16 --kernel occluded_rays) roof=(--rays 16 --megabytes 1)
fi
here=() failed=() missing=()

summarize() {
  {
    [[ ${#here[@]} -gt 0 ]] && printf 'there:   %s\n' "${here[@]}"
    [[ ${#failed[@]} -gt 0 ]] && printf 'failed:  %s\n' "${failed[@]}"
    [[ ${#missing[@]} -gt 0 ]] && printf 'missing: %s\n' "${missing[@]}"
    echo "build logs: $(find "$out/build_logs" -type f | wc -l) in build_logs"
  } >"$out/summary.txt"
}

# part NAME SECONDS COMMAND...: runs the command for at most SECONDS (with --quick, for all the time that is
# left). Its table goes to NAME.txt, the rest to NAME.log.
part() {
  local name=$1 most=$((seconds - SECONDS)) pid watch status
  [[ $quick ]] || most=$(($2 < most ? $2 : most))
  shift 2
  if ((most <= 0)); then
    missing+=("$name: the $seconds seconds were over")
    summarize
    return
  fi
  echo "gpu.sh: $name" >&2
  set -m  # a process group, so that all its processes can be killed
  "$@" >"$out/$name.txt" 2>"$out/$name.log" &
  pid=$!
  (sleep "$most" && touch "$out/$name.late" && kill -- "-$pid") >/dev/null 2>&1 &
  watch=$!
  set +m
  wait "$pid" 2>/dev/null
  status=$?
  kill -- "-$watch" 2>/dev/null
  wait "$watch" 2>/dev/null
  if [[ $status == 0 ]]; then
    here+=("$name")
  else
    local why
    why=$(tail -n 1 "$out/$name.log")
    [[ -e $out/$name.late ]] && why="took longer than $most s"
    failed+=("$name (status $status): $why")
  fi
  rm -f "$out/$name.late"
  summarize
}

# stat_of FILE STEP: prints a step's seconds from a --stats file.
stat_of() { sed -n "/\"seconds\": {/,/}/s/^ *\"$2\": \([0-9.e+-]*\),*\$/\1/p" "$1" | head -n 1; }
is_there() { grep -qs "\"platform_name\": *\"$1" "$out/devices.json"; }

devices() {
  "$sundog" devices --json >"$out/devices.json" && "$sundog" devices
}
pictures() {
  local scene name wrong=0 all=("$scenes"/*.json)
  mkdir -p "$out/pictures"
  [[ $quick ]] && all=("${frame_scenes[@]/%/.json}") && all=("${all[@]/#/$scenes/}")
  for scene in "${all[@]}"; do
    name=$(basename -- "$scene" .json)
    [[ $name == scene.schema ]] && continue
    if ! "$sundog" render "$scene" --device "$device" --size "$small" -q -o "$out/pictures/$name.png"; then
      echo "$name: not drawn"
      wrong=1
    elif [[ -e $root/pictures/$name.png && ! $quick ]]; then
      echo "$name: $("$sundog" compare "$out/pictures/$name.png" "$root/pictures/$name.png" --tolerance 0.02 | grep over)"
    else
      echo "$name: drawn"
    fi
  done
  return $wrong
}
builds() {
  local name run cache
  cache=$(mktemp -d)
  for name in "${frame_scenes[@]}"; do
    for run in cold warm; do
      CUDA_CACHE_DISABLE=1 XDG_CACHE_HOME=$cache "$sundog" render "$scenes/$name.json" --device "$device" --size 8x8 --samples 1 -q \
        --stats "$out/builds-$name-$run.json" -o "$cache/picture.png" || { rm -rf "$cache"; return 1; }
      echo "$name $run: $(stat_of "$out/builds-$name-$run.json" build_kernels) s for kernels, $(stat_of "$out/builds-$name-$run.json" total) s in all"
    done
  done
  rm -rf "$cache"
}
frames() {  # times a scene with as many samples as the device renders in about 8 s, 64 at most
  local name=$1 run samples=1 stats took
  for run in 1 2 3; do  # the first run builds the kernels
    stats=$out/frame-$name-$run.json
    "$sundog" render "$scenes/$name.json" --device "$device" --size "$frame_size" --samples "$samples" -q --stats "$stats" -o "$out/frame-$name.png" ||
      return 1
    took=$(stat_of "$stats" render)
    if [[ $run == 1 ]]; then
      [[ $quick ]] || samples=$(awk -v took="$took" 'BEGIN { n = int(8 / took); print n < 1 ? 1 : n > 64 ? 64 : n }')
    else
      echo "$name: $samples samples a pixel in $took s, $(awk -v size="$frame_size" -v samples="$samples" -v took="$took" \
        'BEGIN { split(size, side, "x"); printf "%.2f", side[1] * side[2] * samples / took / 1e6 }') Msamples/s"
    fi
  done
}
watts() {  # prints the GPU's power and energy during the frames
  awk -F, '{ sum += $2; if (NR == 1) first = $1; last = $1; if ($2 > most) most = $2 }
    END { if (!NR) exit 1; printf "mean %.1f W, most %.1f W, %d readings, one in 100 ms: %.0f J\n", sum / NR, most, NR, sum / 10 }' "$out/power.csv"
}

summarize
part devices 60 devices
command -v nvidia-smi >/dev/null && part nvidia-smi 20 nvidia-smi -q
[[ $quick ]] || part check 150 "$sundog" check --timeout 120 --device "$device"
part pictures 150 pictures
part builds 120 builds
for name in "${frame_scenes[@]}"; do
  SUNDOG_BUILD_LOG=$out/build_logs part "$name-kernels" 40 "$sundog" bench kernels "$scenes/$name.json" --device "$device" \
    --set /render/tracer=compact --json "$out/$name-kernels.json"
done
for model in "${models[@]}"; do
  name=$(basename -- "$model")
  name=${name%.gz}
  name=${name%.*}
  ways=(0 1 2 wide)
  is_there NVIDIA && ways+=(registers-64)
  for way in "${ways[@]}"; do
    options="-DNODE_LOOP=$way" tracer=compact
    [[ $way == registers-64 ]] && options=-cl-nv-maxrregcount=64
    [[ $way == wide ]] && options='' tracer=wide
    SUNDOG_BUILD_OPTIONS=$options part "$name-rays-$way" 60 "$sundog" bench rays "$model" --device "$device" --set "/render/tracer=$tracer" \
      "${bench[@]}" "${rays[@]}" --json "$out/$name-rays-$way.json"
  done
done
if command -v nvidia-smi >/dev/null; then
  nvidia-smi --query-gpu=timestamp,power.draw --format=csv,noheader,nounits -lms 100 >"$out/power.csv" 2>/dev/null &
  power=$!
fi
for name in "${frame_scenes[@]}"; do part "$name-frames" 40 frames "$name"; done
[[ ${power-} ]] && kill "$power"
part workgroup 60 "$sundog" bench workgroup "${models[0]}" --device "$device" "${bench[@]}" "${groups[@]}" \
  --json "$out/workgroup.json" --html "$out/workgroup.html"
part roofline 60 "$sundog" bench roofline "${models[0]}" --device "$device" "${bench[@]}" "${roof[@]}" --json "$out/roofline.json" --svg "$out/roofline.svg"
if [[ -s $out/power.csv ]]; then part joules 10 watts; else missing+=("joules: nvidia-smi reads no watts here"); fi
for model in "${models[@]}"; do
  for peer in embree tinybvh; do
    name=$(basename -- "${model%.gz}")
    name=${name%.*}-$peer
    if [[ -x $programs/${peer}_rays ]]; then
      threads=()
      [[ $peer == embree ]] && threads=(--threads "$(nproc)" --wall)
      part "$name" 60 "$programs/${peer}_rays" "$model" --device "$device" "${threads[@]}" ${quick:+--repeats 1 --size 32} --json "$out/$name.json"
    else
      missing+=("$name: $programs/${peer}_rays was not built (docs/guide/benchmarks.md)")
    fi
  done
done
summarize
cat "$out/summary.txt"
[[ ${#failed[@]} -eq 0 ]]
