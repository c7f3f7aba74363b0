// Intersects the exact solids of kernels/shared/shapes.h in plain C++, one ray at a time, in floats, or in
// double precision as a reference.
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bench/plain/any_solid.h"
#include "shared/bvh.h"

namespace sundog::plain {

struct Ray {
  glm::vec3 o{0}, d{0};
  float t_min = 0, t_max = 0;  // a hit is in (t_min, t_max]
};

struct SolidHit {
  float t = 0;
  glm::vec3 ng{0};  // outward, not normalised
};

/// A unit solid; `profiles`: the scene's table, which holds a lathe's rows.
struct Solid {
  u32 shape;
  const float4& parameters;
  std::span<const ProfileArc> profiles{};
};

/// The nearest crossing of a solid, in its own space.
bool closest_in_solid(const Solid& solid, const Ray& ray, SolidHit& hit);

/// Every crossing of the line o + t d with a solid, in order of t.
std::vector<SolidCrossing> solid_crossings(const Solid& solid, const glm::dvec3& o, const glm::dvec3& d);

}  // namespace sundog::plain
