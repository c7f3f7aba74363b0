// A closed grid over the surface of a cube: the connectivity and the directions that generated surfaces
// share.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace sundog::procedural {

/// Directions of the grid points as seen from the cube's middle (unit length), and triangles
/// counter-clockwise from outside.
struct CubeGrid {
  std::vector<glm::dvec3> directions;
  std::vector<glm::uvec3> triangles;
};

/// `cells` squares along each edge, each cut in two: 12 cells^2 triangles, 6 cells^2 + 2 points. `stretch`
/// scales the cube's axes first, so that the cells stay even on a block of these proportions.
CubeGrid make_cube_grid(int cells, const glm::dvec3& stretch);

}  // namespace sundog::procedural
