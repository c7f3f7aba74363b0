// Detects scenes without light, and world media that absorb all light from infinity.
#pragma once
#include "scene/description.h"

namespace sundog {

/// Whether anything in the scene emits light or shows a colour without light; otherwise its picture is black.
bool has_light(const SceneDescription& scene);

/// Warns, with the remedy, if the world's medium or fog absorbs all light of a sun, sky or directional light.
void warn_of_dark_world(SceneDescription& scene);

}  // namespace sundog
