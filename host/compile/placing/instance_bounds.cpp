// See instance_bounds.h.
#include "compile/placing/instance_bounds.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

float round_down(double value) {
  const auto rounded = static_cast<float>(value);
  return double(rounded) > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}

float round_up(double value) { return -round_down(-value); }

/// How far the shape reaches along `direction` (unit space): of a mesh or a field, its boxes.
double reach(const UnitShape& unit, std::span<const Bounds> boxes, const dvec3& d) {
  if (unit.shape != SHAPE_MESH && unit.shape != SHAPE_SDF) return reach(unit, d);
  double most = -std::numeric_limits<double>::infinity();
  for (const Bounds& box : boxes) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
      sum += d[axis] * double(d[axis] > 0 ? box.upper[axis] : box.lower[axis]);
    most = std::max(most, sum);
  }
  return most;
}

}  // namespace

Bounds world_bounds(const UnitShape& unit, std::span<const Bounds> boxes, const dmat4& world_from_unit,
                    bool exact) {
  Bounds bounds = Bounds::none();
  for (int axis = 0; axis < 3; ++axis) {
    const dvec3 row(world_from_unit[0][axis], world_from_unit[1][axis], world_from_unit[2][axis]);
    const double offset = world_from_unit[3][axis];
    double lower = offset - reach(unit, boxes, -row), upper = offset + reach(unit, boxes, row);
    const double slack = exact ? 0 : 0x1p-22 * std::max({std::abs(lower), std::abs(upper), std::abs(offset)});
    bounds.lower[axis] = round_down(lower - slack);
    bounds.upper[axis] = round_up(upper + slack);
  }
  bounds.lower[3] = bounds.upper[3] = 0;
  return bounds;
}

float4 sphere_around(const Bounds& box) {
  const dvec3 lower(box.lower[0], box.lower[1], box.lower[2]),
      upper(box.upper[0], box.upper[1], box.upper[2]);
  const dvec3 middle = 0.5 * (lower + upper);
  return {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z),
          round_up(0.5 * glm::length(upper - lower))};
}

}  // namespace sundog
