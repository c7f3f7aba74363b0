// Light from all around: the picture, how its directions are chosen, and the sky's sun.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

/// Fills the tables of the environment, and adds its light and its sun to `out.lights`. Nothing without one.
/// `halo`: the map of an environment with crystals.
void add_environment(const SceneDescription& scene, CompiledScene& out, const HaloMap* halo = nullptr);

}  // namespace sundog
