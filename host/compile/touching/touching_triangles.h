// Triangles that lie on others.
#pragma once
#include <span>

#include "scene/description.h"

namespace sundog {

struct PlacedTriangle {
  dvec3 corner[3];
};

/// Whether two triangles lie in one plane, to `tolerance`, and overlap; neighbours along an edge do not.
bool lies_on(const PlacedTriangle& a, const PlacedTriangle& b, double tolerance);

/// Whether any triangle of `a` lies on one of `b`; with no `b` on another one of `a`.
bool any_lies_on(std::span<const PlacedTriangle> a, std::span<const PlacedTriangle> b, double tolerance);

}  // namespace sundog
