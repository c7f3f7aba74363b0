// Tests whether placed triangles coincide: coplanar within a tolerance, and overlapping.
#pragma once
#include <span>

#include "scene/description.h"

namespace sundog {

struct PlacedTriangle {
  dvec3 corner[3];
};

/// Whether two triangles are coplanar within `tolerance` and overlap; neighbours that share an edge do not.
bool lies_on(const PlacedTriangle& a, const PlacedTriangle& b, double tolerance);

/// Whether any triangle of `a` coincides with one of `b`, or, if `b` is empty, with another of `a`.
bool any_lies_on(std::span<const PlacedTriangle> a, std::span<const PlacedTriangle> b, double tolerance);

}  // namespace sundog
