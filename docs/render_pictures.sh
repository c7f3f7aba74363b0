#!/usr/bin/env bash
# Renders every shipped scene to docs/pictures/NAME.png, as the README shows them.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
for scene in "$root"/scenes/*.json; do
  name=$(basename "$scene" .json)
  [ "$name" = scene.schema ] && continue
  "$root/run.sh" render "$scene" -o "$root/docs/pictures/$name.png" "$@"
done
