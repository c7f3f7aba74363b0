// Splits a polygon, given by its corners in order, into triangles of corner indices.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace sundog::models {

/// Limit for concave polygons (ear clipping is quadratic); convex polygons may have any number of corners.
inline constexpr std::size_t most_concave_corners = 8192;

/// Appends corners.size() - 2 triangles of corner indices with the polygon's winding: a fan if the polygon is
/// visible from its first corner (as a convex one is), else by ear clipping in its plane. Collinear corners
/// and crossing edges give degenerate or overlapping triangles, never fewer. Returns false and appends
/// nothing for fewer than three corners, or a concave polygon above `most_concave_corners`.
bool triangulate(std::span<const glm::vec3> corners, std::vector<glm::uvec3>& triangles);

}  // namespace sundog::models
