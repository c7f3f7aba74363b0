// Compiles environment lights: the picture, its sampling tables, and the sky's sun.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

/// Fills the environment's tables, and adds its light and its sun to `out.lights`; nothing without an
/// environment. `halo`: the map of an environment with ice crystals.
void add_environment(const SceneDescription& scene, CompiledScene& out, const HaloMap* halo = nullptr);

}  // namespace sundog
