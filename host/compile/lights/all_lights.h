// Completes the tables of lights, for which the scene's other tables are needed.
#pragma once
#include "compile/steps.h"

namespace sundog {

/// Adds the lights of meshes, the numbers of groups, the tree over lights, and photons. `out` has all other
/// tables, with `lights` among them.
void complete_lights(const SceneDescription& scene, const Lights& lights, const Instances& instances,
                     CompiledScene& out);

}  // namespace sundog
