// Boxes around objects, and the camera that sees all of a box.
#pragma once
#include <limits>
#include <span>

#include "scene/description.h"

namespace sundog {

/// An axis-parallel box; lower > upper when it is empty.
struct SceneBounds {
  dvec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(lower.x <= upper.x); }
  void add(const dvec3& point) { lower = glm::min(lower, point), upper = glm::max(upper, point); }
};

/// Around all objects with an end: planes do not count. Exact for meshes, the box of a box for the turned
/// solids and of the fields' intervals.
SceneBounds bounds_of(std::span<const Object> objects, std::span<const Mesh> meshes,
                      std::span<const SdfDescription> fields = {});

/// `camera` moved so that the box all but fills an image of width / height `aspect`, seen from the front,
/// right and above (y is up). An empty box leaves it where it is.
Camera frame(const SceneBounds& bounds, double aspect, Camera camera);

}  // namespace sundog
