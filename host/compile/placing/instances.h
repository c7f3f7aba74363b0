// Compiles objects to instances: transforms for kernels, flags, and world bounds.
#pragma once
#include <span>
#include <vector>

#include "compile/compiled_scene.h"
#include "compile/mesh_bvh.h"

namespace sundog {

/// Appends an instance per object to `out.instances` (bounded ones first, in leaf order, then planes, then
/// distance fields, which are not in the scene BVH) and the scene BVH to `out.nodes`; sets the related parts
/// of `out.info` and `out.features`. Skips meshes without triangles. Positions are relative to `out.origin`.
/// Returns the instances' world boxes. Throws SceneError for a transform that is not invertible in single
/// precision.
std::vector<Bounds> add_instances(const SceneDescription& scene, const std::vector<PlacedMesh>& meshes,
                                  u32 default_material, CompiledScene& out);

/// Marks instances that touch others, in scenes with media (touching/touching.h).
void find_touching(const SceneDescription& scene, const std::vector<Bounds>& boxes, CompiledScene& out);

/// Whether a camera there, relative to the tables' origin, may be inside a solid with a medium.
bool is_camera_inside(const dvec3& camera, std::span<const Instance> instances,
                      std::span<const Bounds> boxes);

/// The transform from a plane's space to the tables': the plane is shifted along itself by whole periods of
/// its pattern, to bring its origin near. With textures, which may have any period, it is not shifted.
dmat4 place_of_plane(const SceneDescription& scene, const Object& object, const dvec3& origin);

}  // namespace sundog
