// A tree over area lights, by which shading points choose one of many.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

struct LightTree {
  SharedTable<LightNode> light_nodes;  // empty: there is nothing to choose
  SharedTable<u32> light_leaves;       // the node of each light
  SharedTable<LightRay> light_rays;    // rays to given or chosen lights
};

/// Builds a tree over the area lights among `lights` and replaces their rays by `settings.light_samples` rays
/// to chosen lights. There is no tree if that is 0, except for path tracing and mesh lights, or for at most
/// one area light, except for mesh lights.
LightTree make_light_tree(const RenderSettings& settings, const std::vector<Light>& lights,
                          SharedTable<LightRay> rays);

}  // namespace sundog
