// Crossings of a solid by its distance alone (compile/shapes.h), in double precision: for solids that a
// tracer of the benchmarks has no equations for. Slow.
#pragma once
#include <vector>

#include "compile/shapes.h"

namespace sundog {

/// Where a line meets a solid's surface: o + t d, and the outward normal, not normalised.
struct SolidCrossing {
  double t = 0;
  glm::dvec3 ng{0};
};

/// Every crossing of a bounded solid that is never open, nearest first, in unit space. Misses what a line
/// cuts off on less than a millionth of the unit.
std::vector<SolidCrossing> crossings_by_distance(const UnitShape& unit, const glm::dvec3& o,
                                                 const glm::dvec3& d);

}  // namespace sundog
