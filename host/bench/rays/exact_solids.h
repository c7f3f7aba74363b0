// The exact solids of kernels/shared/bvh.h in double precision: closed forms, or root finding that needs
// none.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "shared/bvh.h"

namespace sundog {

struct SolidCrossing {
  double t = 0;
  glm::dvec3 ng{0};  // outward
};

/// Every crossing of the line o + t d with the unit solid's surface, in order of t.
std::vector<SolidCrossing> solid_crossings(u32 shape, const float4& parameters, const glm::dvec3& o,
                                           const glm::dvec3& d);

}  // namespace sundog
