#!/bin/bash
# Measures sundog on one device, usually a GPU, with one command in eight minutes:
#   bench/gpu.sh [--device SPEC] [--seconds N] [--quick] OUT_DIR [MODEL...]
# From a clone it runs build/release/sundog (or the folder SUNDOG_BUILD), from a bundle the bundle's program.
# The parts, in order:
#   the devices; `sundog check`; every scene in 64x64 against the bundle's pictures (a clone has none)
#   builds of all kernels of six scenes (cold, warm), with their logs
#   `bench rays` of three models, or of MODEL..., with each node loop (kernels/lib/trace/single.cl: NODE_LOOP),
#   on NVIDIA devices also with 64 registers
#   samples a second of the six scenes by both integrators; times by work-group size
#   registers and memory as the driver reported them; watts and joules if nvidia-smi reads them
#   the same rays through tinybvh and Embree if these programs are there; the roofline
# Each part writes a table (.txt), figures (.json) and messages (.log) to OUT_DIR as soon as it is done, and
# summary.txt lists it. A part that fails or hangs does not stop the others. Each has its share of N seconds
# (480); what would begin later is left out. The default SPEC is `gpu`. --quick: tiny settings, to test that
# everything runs.
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
integrators=(whitted path)
bench=() rays=(--rays 1024) groups=() roof=() peer_rays=()
if [[ $quick ]]; then
  frame_scenes=(spheres cornell_path)
  frame_size=16x16
  bench=(--repeat 1) rays=(--rays 32) groups=(--rays 16 --kernel occluded_rays) roof=(--rays 16 --megabytes 1)
  peer_rays=(--repeats 1 --size 32)
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

# share MOST END: the parts that follow take MOST seconds each at most, and end by second END; both of 480 and
# in proportion of N. With --quick, any may take all the time that is left.
grace=10  # seconds from SIGTERM to SIGKILL
share() {
  most=$(($1 * seconds / 480)) end=$(($2 * seconds / 480)) last=$((seconds - grace - 2))
  if [[ $quick ]] || ((end > last)); then end=$last; fi
  [[ $quick ]] && most=$seconds
  within=$((most > 10 ? most - 5 : most))  # for programs that keep to a time themselves
}

# limit GROUP SECONDS FILE: after SECONDS makes FILE and ends a group of processes: by SIGTERM, at which sundog
# writes what it has, and by SIGKILL. A process that a driver holds survives this; then `part` stops waiting.
limit() {
  local tenth
  sleep "$2"
  : >"$3"
  kill -- "-$1"
  for ((tenth = 0; tenth < 10 * grace; ++tenth)); do
    kill -0 -- "-$1" || return
    sleep 0.1
  done
  kill -KILL -- "-$1"
  sleep 1
  kill -0 -- "-$1" && kill -USR1 $$
}
trap : USR1

# part NAME COMMAND...: runs the command within its share of time. Its table goes to NAME.txt, the rest to
# NAME.log.
part() {
  local name=$1 time=$((end - SECONDS)) pid watch status
  shift
  ((time > most)) && time=$most
  if ((time <= 0)); then
    missing+=("$name: its share of the $seconds seconds was over (--seconds N gives more)")
    summarize
    return
  fi
  echo "gpu.sh: $name" >&2
  set -m  # a process group, so that all its processes can be killed
  "$@" >"$out/$name.txt" 2>"$out/$name.log" &
  pid=$!
  limit "$pid" "$time" "$out/$name.late" >/dev/null 2>&1 &
  watch=$!
  set +m
  wait "$pid" 2>/dev/null
  status=$?
  [[ -e $out/$name.late ]] || kill -- "-$watch" 2>/dev/null
  wait "$watch" 2>/dev/null
  if [[ $status == 0 ]]; then
    here+=("$name")
  else
    local why
    why=$(tail -n 1 "$out/$name.log")
    [[ -e $out/$name.late ]] && why="took longer than $time s"
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
pictures() {  # the scenes of frames first
  local scene name wrong=0 all=("${frame_scenes[@]/%/.json}")
  mkdir -p "$out/pictures"
  [[ $quick ]] || all+=($(cd "$scenes" && printf '%s\n' *.json | grep -vxF -e scene.schema.json "${all[@]/#/-e}"))
  for scene in "${all[@]}"; do
    name=${scene%.json}
    if ! "$sundog" render "$scenes/$scene" --device "$device" --size 64x64 -q -o "$out/pictures/$name.png"; then
      echo "$name: not drawn"
      wrong=1
    elif [[ -e $root/pictures/$name.png ]]; then
      echo "$name: $("$sundog" compare "$out/pictures/$name.png" "$root/pictures/$name.png" --tolerance 0.02 | grep over)"
    else
      echo "$name: drawn"
    fi
  done
  return $wrong
}
frames() {  # SCENE INTEGRATOR: times as many samples as the device renders in about 2 s
  local name=$1 run samples=1 stats took
  for run in 1 2 3; do  # the first run builds the kernels
    stats=$out/frame-$name-$2-$run.json
    "$sundog" render "$scenes/$name.json" --set "/render/integrator=$2" --device "$device" --size "$frame_size" --samples "$samples" -q \
      --stats "$stats" -o "$out/frame-$name-$2.png" || return 1
    took=$(stat_of "$stats" render)
    if [[ $run == 1 ]]; then
      [[ $quick ]] || samples=$(awk -v took="$took" 'BEGIN { n = int(2 / took); print n < 1 ? 1 : n > 1024 ? 1024 : n }')
    else
      echo "$name, $2: $samples samples a pixel in $took s, $(awk -v size="$frame_size" -v samples="$samples" -v took="$took" \
        'BEGIN { split(size, side, "x"); printf "%.2f", side[1] * side[2] * samples / took / 1e6 }') Msamples/s"
    fi
  done
}
registers() {  # from the reports of builds; `private` is any driver's, the others are NVIDIA's
  awk -F': ' '{ gsub(/[",]/, "", $2); gsub(/[" ]/, "", $1); value[$1] = $2 }
    $1 == "tracer" { printf "%s %s: registers %s, stack %s B, spilled %s B, private %s B\n", value["scene"], value["kernel"],
      value["registers"], value["stack_B"], value["spill_stores_B"], value["private_B"] }' "$out"/*-builds.json |
    sed 's/ null\( B\)\{0,1\}/ not reported/g' | grep .
}
watts() {  # prints the GPU's power and energy during the frames
  awk -F, '{ sum += $2; if (NR == 1) first = $1; last = $1; if ($2 > most) most = $2 }
    END { if (!NR) exit 1; printf "mean %.1f W, most %.1f W, %d readings, one in 100 ms: %.0f J\n", sum / NR, most, NR, sum / 10 }' "$out/power.csv"
}

summarize
share 20 20
part devices devices
command -v nvidia-smi >/dev/null && share 10 30 && part nvidia-smi nvidia-smi -q
share 80 110
[[ $quick ]] || part check "$sundog" check --timeout "$((within > 0 ? within : 1))" --device "$device"
share 75 185
part pictures pictures
share 30 245
for name in "${frame_scenes[@]}"; do
  SUNDOG_BUILD_LOG=$out/build_logs part "$name-builds" "$sundog" bench kernels "$scenes/$name.json" --device "$device" \
    --json "$out/$name-builds.json"
done
share 25 345
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
    SUNDOG_BUILD_OPTIONS=$options part "$name-rays-$way" "$sundog" bench rays "$model" --device "$device" --set "/render/tracer=$tracer" \
      "${bench[@]}" "${rays[@]}" --json "$out/$name-rays-$way.json"
  done
done
share 20 425
if command -v nvidia-smi >/dev/null; then
  nvidia-smi --query-gpu=timestamp,power.draw --format=csv,noheader,nounits -lms 100 >"$out/power.csv" 2>/dev/null &
  power=$!
fi
for name in "${frame_scenes[@]}"; do
  for integrator in "${integrators[@]}"; do part "$name-$integrator-frames" frames "$name" "$integrator"; done
done
[[ ${power-} ]] && kill -KILL "$power"
share 20 445
part workgroup "$sundog" bench workgroup "${models[0]}" --device "$device" "${bench[@]}" "${groups[@]}" --budget "$within" \
  --json "$out/workgroup.json" --html "$out/workgroup.html"
share 10 450
part registers registers
if [[ -s $out/power.csv ]]; then part joules watts; else missing+=("joules: nvidia-smi reads no watts here"); fi
share 10 468
for peer in tinybvh embree; do
  program=$programs/${peer}_rays
  if [[ ! -x $program ]]; then
    missing+=("$peer: $program was not built (docs/how-it-works/peer-programs.md)")
    continue
  fi
  options=()
  [[ $peer == embree ]] && options=(--threads "$(nproc)" --wall)
  [[ $peer == tinybvh && -d $root/tinybvh ]] && options=(--tinybvh "$root/tinybvh")
  for model in "${models[@]}"; do
    name=$(basename -- "${model%.gz}")
    name=${name%.*}-$peer
    part "$name" "$program" "$model" --device "$device" "${options[@]}" "${peer_rays[@]}" --json "$out/$name.json"
  done
done
part roofline "$sundog" bench roofline "${models[0]}" --device "$device" "${bench[@]}" "${roof[@]}" --json "$out/roofline.json" --svg "$out/roofline.svg"
summarize
cat "$out/summary.txt"
[[ ${#failed[@]} -eq 0 ]]
