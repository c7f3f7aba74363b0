// The exact solids of kernels/shared/shapes.h in double precision: closed forms, or root finding that needs
// none.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "bench/plain/any_solid.h"

namespace sundog {

/// Every crossing of the line o + t d with the unit solid's surface, in order of t.
std::vector<SolidCrossing> solid_crossings(u32 shape, const float4& parameters, const glm::dvec3& o,
                                           const glm::dvec3& d);

}  // namespace sundog
