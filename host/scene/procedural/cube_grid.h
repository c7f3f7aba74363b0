// A closed grid over a cube's surface: topology and directions for generated surfaces.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace sundog::procedural {

/// Unit directions of the grid points from the cube's centre, and triangles, counterclockwise from outside.
struct CubeGrid {
  std::vector<glm::dvec3> directions;
  std::vector<glm::uvec3> triangles;
};

/// Makes `cells` squares along each edge, each split in two: 12 cells^2 triangles, 6 cells^2 + 2 points.
/// `stretch` scales the axes first, so that cells stay even on a block of these proportions.
CubeGrid make_cube_grid(int cells, const glm::dvec3& stretch);

}  // namespace sundog::procedural
