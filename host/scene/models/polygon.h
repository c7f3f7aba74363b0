// Polygons become triangles.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace sundog::models {

/// A concave polygon may have this many corners (ear clipping is quadratic); convex ones any number.
inline constexpr std::size_t most_concave_corners = 8192;

/// Appends corners.size() - 2 triangles of corner numbers, wound as the polygon is: a fan where the polygon
/// is seen whole from its first corner (as a convex one is), else by ear clipping in the polygon's plane.
/// Corners on one line and crossing edges make triangles without area or overlapping ones, never fewer.
/// Returns false, and appends nothing, for a polygon with fewer than three corners or a concave one above
/// `most_concave_corners`.
bool triangulate(std::span<const glm::vec3> corners, std::vector<glm::uvec3>& triangles);

}  // namespace sundog::models
