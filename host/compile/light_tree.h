// A tree over area lights, by which shading points choose one of many.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

/// Fills `out.light_nodes` for the area lights in `out.lights`, and replaces their rays in `out.light_rays`
/// by the number in `scene.render.light_samples`. Does nothing if that is 0 or there is at most one area
/// light.
void add_light_tree(const SceneDescription& scene, CompiledScene& out);

}  // namespace sundog
