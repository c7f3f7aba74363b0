#!/bin/bash
# All that is worth knowing of sundog on one device, most of all a GPU, by one command:
#   bench/gpu.sh [--device SPEC] [--quick] OUT_DIR MODEL...
# What the device is; of each kernel its group sizes, memory, registers and spills, and the build logs; rays a second
# by kind with both tracers; times by work-group size; the same rays through Embree on the host's cores and
# through tinybvh's OpenCL kernels, where these programs were built (cmake -DSUNDOG_TINYBVH=CHECKOUT). On
# NVIDIA's devices kernels and rays once more with registers limited to 128 and 64. Each part leaves a table (.txt), figures
# (.json) and what it said on the way (.log) in OUT_DIR; one that fails does not keep the others from running.
# SPEC is `gpu` without the option. --quick: tiny settings, to see whether everything runs.
# SUNDOG_BUILD: the folder with the programs (build/release). GPU_PART_LIMIT: seconds a part may take (900).
set -u
root=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${root%/*/*}
programs=${SUNDOG_BUILD:-$root/build/release}
limit=${GPU_PART_LIMIT:-900}
device=gpu
quick=
while [[ ${1-} == --* ]]; do
  case $1 in
    --device) device=${2:?--device: wanted a SPEC}; shift 2 ;;
    --quick) quick=1; shift ;;
    *) echo "gpu.sh: $1: wanted --device SPEC or --quick" >&2; exit 2 ;;
  esac
done
if [[ $# -lt 2 ]]; then
  echo "usage: gpu.sh [--device SPEC] [--quick] OUT_DIR MODEL..." >&2
  exit 2
fi
out=$1
shift
mkdir -p -- "$out/build_logs" || exit 1
out=$(readlink -f -- "$out")

bench=() rays=() groups=() peers=()
if [[ $quick ]]; then
  bench=(--repeat 1)
  rays=(--rays 32)
  groups=(--rays 16 --kernel occluded_rays)
  peers=(--repeats 1 --size 32)
fi
here=() failed=() missing=()

# part NAME COMMAND...: runs it with its table to NAME.txt and the rest to NAME.log.
part() {
  local name=$1
  shift
  echo "gpu.sh: $name" >&2
  if timeout "$limit" "$@" >"$out/$name.txt" 2>"$out/$name.log"; then
    here+=("$name")
  else
    local status=$?
    local why
    why=$(tail -n 1 "$out/$name.log")
    [[ $status == 124 ]] && why="took longer than $limit s"
    failed+=("$name (status $status): $why")
  fi
}

sundog=$programs/sundog
part devices "$sundog" devices
"$sundog" devices --json >"$out/devices.json" 2>>"$out/devices.log"
command -v nvidia-smi >/dev/null && part nvidia-smi nvidia-smi -q

for model in "$@"; do
  name=$(basename -- "$model")
  name=${name%.gz}
  name=${name%.*}
  for tracer in compact wide; do
    common=("$model" --device "$device" --set "/render/tracer=$tracer")
    SUNDOG_BUILD_LOG=$out/build_logs part "$name-kernels-$tracer" \
      "$sundog" bench kernels "${common[@]}" --json "$out/$name-kernels-$tracer.json"
    part "$name-rays-$tracer" \
      "$sundog" bench rays "${common[@]}" "${bench[@]}" "${rays[@]}" --json "$out/$name-rays-$tracer.json"
    if grep -q '"platform_name": *"NVIDIA' "$out/devices.json" && [[ $tracer == compact ]]; then
      for registers in 128 64; do
        export SUNDOG_BUILD_OPTIONS=-cl-nv-maxrregcount=$registers
        SUNDOG_BUILD_LOG=$out/build_logs part "$name-kernels-$tracer-$registers" \
          "$sundog" bench kernels "${common[@]}" --json "$out/$name-kernels-$tracer-$registers.json"
        part "$name-rays-$tracer-$registers" "$sundog" bench rays "${common[@]}" "${bench[@]}" "${rays[@]}" \
          --json "$out/$name-rays-$tracer-$registers.json"
        unset SUNDOG_BUILD_OPTIONS
      done
    fi
  done
  part "$name-workgroup" "$sundog" bench workgroup "$model" --device "$device" "${bench[@]}" "${groups[@]}" \
    --json "$out/$name-workgroup.json" --html "$out/$name-workgroup.html"
  if [[ -x $programs/embree_rays ]]; then
    part "$name-embree" "$programs/embree_rays" "$model" --device "$device" --threads "$(nproc)" --wall \
      "${peers[@]}" --json "$out/$name-embree.json"
  else
    missing+=("$name-embree: $programs/embree_rays was not built (libembree-dev, target embree_rays)")
  fi
  if [[ -x $programs/tinybvh_rays ]]; then
    part "$name-tinybvh" "$programs/tinybvh_rays" "$model" --device "$device" "${peers[@]}" \
      --json "$out/$name-tinybvh.json"
  else
    missing+=("$name-tinybvh: $programs/tinybvh_rays was not built (cmake --preset release -DSUNDOG_TINYBVH=CHECKOUT)")
  fi
done

{
  printf 'there:   %s\n' "${here[@]}"
  [[ ${#failed[@]} -gt 0 ]] && printf 'failed:  %s\n' "${failed[@]}"
  [[ ${#missing[@]} -gt 0 ]] && printf 'missing: %s\n' "${missing[@]}"
  echo "build logs: $(find "$out/build_logs" -type f | wc -l) in build_logs"
} | tee "$out/summary.txt"
[[ ${#failed[@]} -eq 0 ]]
