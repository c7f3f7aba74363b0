#!/usr/bin/env bash
# Renders every shipped scene to docs/pictures/NAME.png and every surface of the list to docs/pictures/formulas.png, as the
# pages show them. Arguments go to `render`. The second needs the bench programs (./test.sh builds them).
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
for scene in "$root"/scenes/*.json; do
  name=$(basename "$scene" .json)
  case "$name" in scene.schema | fractal_light_*) continue ;; esac
  "$root/run.sh" render "$scene" -o "$root/docs/pictures/$name.png" "$@"
done
"$root/run.sh" render "$root/docs/presets.json" -o "$root/docs/pictures/presets.jpg" "$@"
"$root/run.sh" halo "$root/scenes/sundog.json" -o "$root/docs/pictures/halo_fisheye.png" --view fisheye --sky --size 600
if [ -x "$root/build/release/bench/formula_sheet" ]; then
  "$root/build/release/bench/formula_sheet" --size 180 -o "$root/docs/pictures/formulas.png"
  "$root/build/release/bench/formula_sheet" --size 96 --no-names -o "$root/host/app/serve/page/surfaces.jpg"  # the viewer's list
fi
