#!/usr/bin/env bash
# Renders every shipped scene to docs/pictures/NAME.png, as the README shows them.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
for scene in "$root"/scenes/*.json; do
  name=$(basename "$scene" .json)
  case "$name" in scene.schema | fractal_light_*) continue ;; esac
  "$root/run.sh" render "$scene" -o "$root/docs/pictures/$name.png" "$@"
done
