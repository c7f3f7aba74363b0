// Transforms the corners of each object's box, and places a camera in front of the box around all.
#include "scene/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sundog {

namespace {

/// Half the size of a solid's bounding box about its origin; negative for meshes, fields and planes.
struct HalfSize {
  dvec3 operator()(const MeshShape&) const { return dvec3(-1); }
  dvec3 operator()(const FieldShape&) const { return dvec3(-1); }
  dvec3 operator()(const PlaneShape&) const { return dvec3(-1); }
  template <class Solid>
  dvec3 operator()(const Solid& solid) const {
    return solid.half_size();
  }
};

std::array<dvec3, 8> corners_of(const dvec3& half) {
  std::array<dvec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = half * dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  return corners;
}

}  // namespace

SceneBounds bounds_of(std::span<const Object> objects, std::span<const Mesh> meshes,
                      std::span<const SdfDescription> fields) {
  SceneBounds bounds;
  for (const Object& object : objects) {
    const auto add = [&](const dvec3& point) {
      bounds.add(dvec3(object.world_from_object * glm::dvec4(point, 1)));
    };
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) {
      for (const glm::vec3& point : meshes[static_cast<std::size_t>(shape->mesh)].positions) add(point);
    } else if (const auto* field = std::get_if<FieldShape>(&object.shape)) {
      const SdfDescription& f = fields[static_cast<std::size_t>(field->field)];
      for (const dvec3& corner : corners_of((f.upper - f.lower) * 0.5))
        add((f.lower + f.upper) * 0.5 + corner);
    } else if (const dvec3 half = std::visit(HalfSize{}, object.shape); half.x >= 0) {
      for (const dvec3& corner : corners_of(half)) add(corner);
    }
  }
  return bounds;
}

Camera frame(const SceneBounds& bounds, double aspect, Camera camera) {
  if (bounds.empty()) return camera;
  const double tall = std::tan(glm::radians(camera.fov) / 2), wide = tall * aspect;
  const dvec3 back = glm::normalize(dvec3(0.55, 0.4, 1)),
              right = glm::normalize(glm::cross(dvec3(0, 1, 0), back));
  const dvec3 up = glm::cross(back, right), half = (bounds.upper - bounds.lower) * 0.5;
  // Each corner needs a distance at which it reaches the edge of the image.
  double distance = 0;
  for (const dvec3& corner : corners_of(half)) {
    const double across =
        std::max(std::abs(glm::dot(corner, right)) / wide, std::abs(glm::dot(corner, up)) / tall);
    distance = std::max(distance, across * 1.05 + glm::dot(corner, back));
  }
  camera.target = (bounds.lower + bounds.upper) * 0.5;
  camera.position = camera.target + back * (distance > 0 ? distance : 1);
  camera.up = dvec3(0, 1, 0);
  return camera;
}

}  // namespace sundog
