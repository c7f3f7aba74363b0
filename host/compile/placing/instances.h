// Objects to instances: transforms as the kernels use them, flags, and bounds in the world.
#pragma once
#include <span>
#include <vector>

#include "compile/compiled_scene.h"
#include "compile/mesh_bvh.h"

namespace sundog {

/// Appends one instance an object to `out.instances` (bounded ones first, in leaf order, then planes, then
/// distance fields, which the scene BVH does not hold), the scene BVH to
/// `out.nodes`, and fills the parts of `out.info` and `out.features` that speak of them. Meshes without
/// triangles are left out. All positions count from `out.origin`. Returns the instances' boxes in the world.
/// Throws SceneError for a transform that cannot be inverted in single precision.
std::vector<Bounds> add_instances(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes,
                                  u32 default_material, CompiledScene& out);

/// Marks the instances that lie on others, where a scene has media (touching/touching.h).
void find_touching(const SceneDescription& scene, const std::vector<Bounds>& boxes, CompiledScene& out);

/// Whether a camera there, from the tables' origin, may be inside a solid with a medium.
bool is_camera_inside(const dvec3& camera, std::span<const Instance> instances,
                      std::span<const Bounds> boxes);

/// From a plane's own space to the tables': it is moved along itself, so that the middle of its space is
/// near, by whole periods of its pattern. With textures, which may have any period, it stays.
dmat4 place_of_plane(const SceneDescription& scene, const Object& object, const dvec3& origin);

}  // namespace sundog
