// A softened star-shaped solid, as the distance from the origin to its surface in each direction.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/procedural/ice_block.h"

namespace sundog::procedural {

/// A plane that keeps the points with dot(normal, p) <= distance; distance > 0.
struct Cut {
  glm::dvec3 normal;
  double distance;
};

/// A ball to be removed; it must not contain the origin.
struct Scoop {
  glm::dvec3 center;
  double radius;
};

/// The intersection of half spaces minus some balls. With g_i(d) the inverse distance along d to surface i,
/// the solid ends at 1 / (sum g_i^q)^(1/q): a norm whose exponent q = 2^doublings sets the sharpness of the
/// edges.
struct SoftSolid {
  std::vector<Cut> cuts;
  std::vector<Scoop> scoops;
  int doublings = 5;
  double roughness = 0;
  double feature_size = 1;  // size of the ripples
  std::uint64_t seed = 0;
};

/// Makes the solid of a surface. Throws GenerateError if the origin is not well inside.
SoftSolid make_soft_solid(const IceSurface& surface, std::uint64_t seed);

/// The distance from the origin to the surface along the unit vector `direction`; > 0.
double surface_distance(const SoftSolid& solid, const glm::dvec3& direction);

}  // namespace sundog::procedural
