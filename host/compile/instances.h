// Objects to instances: transforms as the kernels use them, flags, and bounds in the world.
#pragma once
#include <vector>

#include "compile/compiled_scene.h"
#include "compile/mesh_bvh.h"

namespace sundog {

/// Appends one instance an object to `out.instances` (bounded ones first, in leaf order, then planes, then
/// distance fields, which the scene BVH does not hold), the scene BVH to
/// `out.nodes`, and fills the parts of `out.info` and `out.features` that speak of them. Meshes without
/// triangles are left out. All positions count from `out.origin`. Throws SceneError for a transform that
/// cannot be inverted in single precision.
void add_instances(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes, u32 default_material,
                   CompiledScene& out);

}  // namespace sundog
