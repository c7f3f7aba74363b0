#include "scene/bounds.h"

#include <algorithm>
#include <cmath>

namespace sundog {

namespace {

/// Half the size of the box of a solid about its origin; no size for what has no end.
struct HalfSize {
  dvec3 operator()(const MeshShape&) const { return dvec3(-1); }
  dvec3 operator()(const PlaneShape&) const { return dvec3(-1); }
  dvec3 operator()(const SphereShape& s) const { return dvec3(s.radius); }
  dvec3 operator()(const BoxShape& s) const { return s.half; }
  dvec3 operator()(const RoundBoxShape& s) const { return s.half; }
  dvec3 operator()(const CylinderShape& s) const { return {s.radius, s.half_height, s.radius}; }
  dvec3 operator()(const DiskShape& s) const { return {s.radius, 0, s.radius}; }
  dvec3 operator()(const ConeShape& s) const {
    const double radius = std::max(s.bottom_radius, s.top_radius);
    return {radius, s.half_height, radius};
  }
  dvec3 operator()(const TorusShape& s) const {
    const double radius = s.major_radius + s.minor_radius;
    return {radius, s.minor_radius, radius};
  }
};

}  // namespace

Bounds bounds_of(std::span<const Object> objects, std::span<const Mesh> meshes) {
  Bounds bounds;
  for (const Object& object : objects) {
    const auto add = [&](const dvec3& point) {
      bounds.add(dvec3(object.world_from_object * glm::dvec4(point, 1)));
    };
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) {
      for (const glm::vec3& point : meshes[static_cast<std::size_t>(shape->mesh)].positions) add(point);
    } else if (const dvec3 half = std::visit(HalfSize{}, object.shape); half.x >= 0) {
      for (int corner = 0; corner < 8; ++corner)
        add(half * dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    }
  }
  return bounds;
}

Camera frame(const Bounds& bounds, double aspect, Camera camera) {
  if (bounds.empty()) return camera;
  const double half_diagonal = glm::length(bounds.upper - bounds.lower) / 2;
  const double radius = half_diagonal > 0 ? half_diagonal : 1;
  const double half_height = std::tan(glm::radians(camera.fov) / 2);
  const double half_angle = std::atan(half_height * std::min(aspect, 1.0));
  camera.target = (bounds.lower + bounds.upper) * 0.5;
  camera.position = camera.target + glm::normalize(dvec3(0.55, 0.4, 1)) * (radius / std::sin(half_angle));
  camera.up = dvec3(0, 1, 0);
  return camera;
}

}  // namespace sundog
