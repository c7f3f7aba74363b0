// Compiles objects to instances: transforms for kernels, flags, world bounds, and the BVH over them.
#pragma once
#include <span>

#include "compile/steps.h"

namespace sundog {

/// Whether a camera at this position, relative to the tables' origin, may be inside a solid with a medium.
bool is_camera_inside(const dvec3& camera, std::span<const Instance> instances,
                      std::span<const Bounds> boxes);

/// The transform from a plane's space to the tables': the plane is shifted along itself by whole periods of
/// its pattern, to bring its origin near. With textures, which may have any period, it is not shifted.
dmat4 place_of_plane(const SceneDescription& scene, const Object& object, const dvec3& origin);

}  // namespace sundog
