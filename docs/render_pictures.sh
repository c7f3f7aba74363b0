#!/usr/bin/env bash
# Renders every shipped scene, at least 960 pixels wide, to docs/pictures/NAME.jpg and every surface of the list to docs/pictures/formulas.png, as the
# pages show them. Arguments go to `render`. The second needs the bench programs (./test.sh builds them).
# `render_pictures.sh gallery [NAME...] [OPTION...]` renders the scenes of scenes/gallery instead, all or those named, with as many
# samples as each scene says, so each takes the time that docs/gallery.md states. What is interrupted continues where it was.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
if [ "${1:-}" = gallery ]; then
  shift
  scenes=$root/scenes/gallery pictures=$root/docs/pictures/gallery names=()
  [ -e "$scenes/whisky_glass.ply" ] || "$scenes/make_meshes.py"
  while [ $# -gt 0 ] && [[ $1 != -* ]]; do names+=("$1"); shift; done
  [ ${#names[@]} -gt 0 ] || mapfile -t names < <(cd "$scenes" && basename -s .json ./*.json)
  for name in "${names[@]}"; do
    "$root/run.sh" render "$scenes/$name.json" -o "$pictures/$name.jpg" --denoise --resume "$pictures/$name.checkpoint" "$@"
  done
  exit
fi
[ $# -gt 0 ] || set -- --samples 64
number() { grep -o "\"$2\": *[0-9]*" "$1" | head -1 | grep -o '[0-9]*$'; }
for scene in "$root"/scenes/*.json; do
  name=$(basename "$scene" .json)
  case "$name" in scene.schema | fractal_light_* | antialiasing | cornell) continue ;; esac
  width=$(number "$scene" width) height=$(number "$scene" height)
  large=$((width < 960 ? 960 : width))
  clean=$(grep -q '"integrator": "path"' "$scene" && echo --denoise || true)
  kind=$(grep -q '"transparent": true' "$scene" && echo png || echo jpg)
  "$root/run.sh" render "$scene" -o "$root/docs/pictures/$name.$kind" --size "${large}x$((large * height / width))" $clean "$@"
done
"$root/run.sh" render "$root/scenes/gallery/mountain_lake.json" -o "$root/docs/pictures/evening.jpg" --size 960x540 \
  --denoise --exposure 8.7 --set /environment/sun/altitude=-4 --set /environment/sun/azimuth=15 --set /environment/turbidity=4 "$@"
"$root/run.sh" render "$root/docs/presets.json" -o "$root/docs/pictures/presets.jpg" "$@"
"$root/run.sh" halo "$root/scenes/sundog.json" -o "$root/docs/pictures/halo_fisheye.jpg" --view fisheye --sky --size 960
if [ -x "$root/build/release/bench/formula_sheet" ]; then
  "$root/build/release/bench/formula_sheet" --size 180 -o "$root/docs/pictures/formulas.png"
  "$root/build/release/bench/formula_sheet" --size 96 --no-names -o "$root/host/app/serve/page/surfaces.jpg"  # the viewer's list
fi
