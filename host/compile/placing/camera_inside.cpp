// Finds out whether a camera may be inside a solid with a medium, by boxes and planes.
#include <cmath>

#include "compile/placing/instances.h"

namespace sundog {
namespace {

/// Whether the camera may be inside this solid with a medium.
bool may_contain(const Instance& instance, const Bounds& box, const dvec3& camera) {
  if (!(instance.flags & INSTANCE_TRANSMITS)) return false;
  if (instance.shape == SHAPE_PLANE) {
    const float4& row = instance.object_from_world[1];
    const dvec3 normal(row.x, row.y, row.z);
    return glm::dot(normal, camera) + double(row.w) <=
           1e-6 * (glm::length(normal) * glm::length(camera) + std::abs(double(row.w)));
  }
  for (int axis = 0; axis < 3; ++axis)
    if (camera[axis] < double(box.lower[axis]) || camera[axis] > double(box.upper[axis])) return false;
  return true;
}

}  // namespace

bool is_camera_inside(const dvec3& camera, std::span<const Instance> instances,
                      std::span<const Bounds> boxes) {
  for (std::size_t i = 0; i < instances.size(); ++i)
    if (may_contain(instances[i], boxes[i], camera)) return true;
  return false;
}

}  // namespace sundog
