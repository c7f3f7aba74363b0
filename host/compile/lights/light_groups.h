// Writes the numbers of groups into the tables of lights, materials and the environment.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

/// After all lights have rows; changes nothing in a scene without groups.
void set_light_groups(const SceneDescription& scene, CompiledScene& out);

}  // namespace sundog
