// A tree over area lights, by which shading points choose one of many.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

struct LightTree {
  SharedTable<LightNode> light_nodes;  // empty: there is nothing to choose
  SharedTable<u32> light_leaves;       // of each light: its node
  SharedTable<LightRay> light_rays;    // to lights, or to chosen ones
};

/// A tree over the area lights among `lights`, whose rays become `settings.light_samples` to chosen lights.
/// None if that is 0 or there is at most one area light, but for paths and triangles.
LightTree make_light_tree(const RenderSettings& settings, const std::vector<Light>& lights,
                          SharedTable<LightRay> rays);

}  // namespace sundog
