// Steps along the line by the distance to the surface, within which no crossing can lie, and bisects where
// the sign changes; normals are central differences.
#include "bench/plain/any_solid.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

using glm::dvec3;

constexpr double least_step = 1e-6;

/// The radius of a ball around the origin that contains the solid.
double radius_of(const UnitShape& unit) {
  dvec3 corner(0);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      dvec3 along(0);
      along[axis] = side;
      corner[axis] = std::max(corner[axis], reach(unit, along));
    }
  return glm::length(corner);
}

dvec3 gradient(const UnitShape& unit, const dvec3& p) {
  constexpr double step = 1e-6;
  dvec3 g;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 ahead = p, behind = p;
    ahead[axis] += step, behind[axis] -= step;
    g[axis] = unit_distance(unit, ahead) - unit_distance(unit, behind);
  }
  return g;
}

}  // namespace

std::vector<SolidCrossing> crossings_by_distance(const UnitShape& unit, const dvec3& o, const dvec3& d) {
  std::vector<SolidCrossing> found;
  const double length = glm::length(d), radius = radius_of(unit) + 1e-3;
  const dvec3 along = d / length;
  const double middle = -glm::dot(o, along), off = glm::length(o + middle * along);
  if (!(off < radius)) return found;
  const double half = std::sqrt(radius * radius - off * off);
  const auto distance = [&](double s) { return unit_distance(unit, o + s * along); };
  double last = middle - half, at_last = distance(last);
  while (last < middle + half) {
    const double next = last + std::max(std::abs(at_last), least_step), at_next = distance(next);
    if ((at_last < 0) != (at_next < 0)) {
      double a = last, b = next;
      for (int i = 0; i < 60; ++i) {
        const double between = 0.5 * (a + b);
        ((distance(between) < 0) == (at_last < 0) ? a : b) = between;
      }
      found.push_back({0.5 * (a + b) / length, gradient(unit, o + a * along)});
    }
    last = next, at_last = at_next;
  }
  return found;
}

}  // namespace sundog
