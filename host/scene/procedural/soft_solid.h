// A softened, star-shaped solid: how far its surface is from the origin in each direction.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/procedural/ice_block.h"

namespace sundog::procedural {

/// Points with dot(normal, p) <= distance are inside; distance > 0.
struct Cut {
  glm::dvec3 normal;
  double distance;
};

/// A ball that is taken away; the origin is outside it.
struct Scoop {
  glm::dvec3 center;
  double radius;
};

/// The intersection of half spaces less some balls. With g_i(d) the inverse of the distance along d to
/// surface i, the solid ends at 1 / (sum g_i^q)^(1/q): a norm whose exponent q = 2^doublings says how sharp
/// the edges are.
struct SoftSolid {
  std::vector<Cut> cuts;
  std::vector<Scoop> scoops;
  int doublings = 5;
  double roughness = 0;
  double feature_size = 1;  // of the ripples
  std::uint64_t seed = 0;
};

/// Throws GenerateError when the origin is not well inside.
SoftSolid make_soft_solid(const IceSurface& surface, std::uint64_t seed);

/// Distance from the origin to the surface along the unit vector `direction`; > 0.
double surface_distance(const SoftSolid& solid, const glm::dvec3& direction);

}  // namespace sundog::procedural
