// Bounding boxes of objects, and a camera that frames a box.
#pragma once
#include <limits>
#include <span>

#include "scene/description.h"

namespace sundog {

/// An axis-aligned box; empty if lower > upper.
struct SceneBounds {
  dvec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(lower.x <= upper.x); }
  void add(const dvec3& point) { lower = glm::min(lower, point), upper = glm::max(upper, point); }
};

/// Bounds of all finite objects (planes are skipped): exact for meshes; for solids and fields, of their
/// transformed bounding boxes.
SceneBounds bounds_of(std::span<const Object> objects, std::span<const Mesh> meshes,
                      std::span<const SdfDescription> fields = {});

/// Moves `camera` so that the box nearly fills an image of width / height `aspect`, seen from the front,
/// right and above (y is up). Returns it unchanged for an empty box.
Camera frame(const SceneBounds& bounds, double aspect, Camera camera);

}  // namespace sundog
