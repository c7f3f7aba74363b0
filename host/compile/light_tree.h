// A tree over the lights with an extent, by which points choose one of many.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

/// Fills `out.light_nodes` for the lights with an extent of `out.lights`, and replaces their rays in
/// `out.light_rays` by as many chosen ones as `scene.render.light_samples` says. Nothing where that is 0, or
/// no more than one light has an extent.
void add_light_tree(const SceneDescription& scene, CompiledScene& out);

}  // namespace sundog
