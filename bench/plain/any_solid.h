// Finds a solid's crossings from its distance function alone (compile/shapes.h), in double precision, for
// solids for which a benchmark's tracer has no equations. Slow.
#pragma once
#include <vector>

#include "compile/shapes.h"

namespace sundog {

/// A point o + t d where a line crosses a solid's surface, and the outward normal there, not normalised.
struct SolidCrossing {
  double t = 0;
  glm::dvec3 ng{0};
};

/// Every crossing of a bounded, closed solid, in unit space, by ascending t. Misses pieces of the line inside
/// the solid that are shorter than a millionth of the unit.
std::vector<SolidCrossing> crossings_by_distance(const UnitShape& unit, const glm::dvec3& o,
                                                 const glm::dvec3& d);

}  // namespace sundog
