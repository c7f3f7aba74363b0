// Takes both surfaces from soft_solid.h over one grid from cube_grid.h; the liquid ends within the wall and
// is cut flat at its level.
#include "scene/procedural/ice_block.h"

#include <algorithm>

#include "scene/procedural/cube_grid.h"
#include "scene/procedural/random.h"
#include "scene/procedural/soft_solid.h"

namespace sundog {

namespace {

using glm::dvec3;
using namespace procedural;

// The distances of both surfaces over one grid.
struct Shell {
  CubeGrid grid;
  std::vector<double> outer, cavity;  // cavity is empty for a solid block
};

constexpr double least_wall = 0.02;  // relative to the distance to the outside

SoftSolid cavity_solid(const IceBlock& block) { return make_soft_solid(block.cavity, block.seed * 2 + 1); }

std::vector<double> distances(const SoftSolid& solid, const CubeGrid& grid) {
  std::vector<double> result;
  result.reserve(grid.directions.size());
  for (const dvec3& direction : grid.directions) result.push_back(surface_distance(solid, direction));
  return result;
}

void check_wall(const Shell& shell) {
  for (std::size_t i = 0; i < shell.outer.size(); i++) {
    if (shell.cavity[i] > (1 - least_wall) * shell.outer[i])
      throw GenerateError(
          "cavity: wanted it inside the block, but it breaks through the side; make its size or offset "
          "smaller");
  }
}

Shell make_shell(const IceBlock& block) {
  const SoftSolid outer = make_soft_solid(block.outer, block.seed * 2);
  Shell shell{make_cube_grid(block.subdivision, block.outer.size), {}, {}};
  shell.outer = distances(outer, shell.grid);
  if (block.hollow) {
    shell.cavity = distances(cavity_solid(block), shell.grid);
    check_wall(shell);
  }
  return shell;
}

// Adds a surface to the mesh; `inward` reverses its triangles.
void append_surface(Mesh& mesh, const CubeGrid& grid, const std::vector<dvec3>& points, bool inward) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  for (const dvec3& p : points) mesh.positions.emplace_back(p);
  for (const glm::uvec3& t : grid.triangles) {
    const glm::uvec3 moved = t + first;
    mesh.triangles.push_back(inward ? glm::uvec3{moved.x, moved.z, moved.y} : moved);
  }
}

std::vector<dvec3> surface_points(const CubeGrid& grid, const std::vector<double>& distance) {
  std::vector<dvec3> points;
  points.reserve(distance.size());
  for (std::size_t i = 0; i < distance.size(); i++) points.push_back(grid.directions[i] * distance[i]);
  return points;
}

// Area-weighted means of the adjacent triangles' normals.
void add_smooth_normals(Mesh& mesh) {
  std::vector<dvec3> sums(mesh.positions.size(), dvec3{0, 0, 0});
  for (const glm::uvec3& t : mesh.triangles) {
    const dvec3 a(mesh.positions[t.x]), e1 = dvec3(mesh.positions[t.y]) - a,
                                        e2 = dvec3(mesh.positions[t.z]) - a;
    const dvec3 normal{e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
    for (const unsigned corner : {t.x, t.y, t.z}) sums[corner] += normal;
  }
  mesh.normals.reserve(sums.size());
  for (const dvec3& sum : sums) mesh.normals.emplace_back(length(sum) > 0 ? normalized(sum) : dvec3{0, 1, 0});
}

// Moves points above the plane down to it, towards `pole`, from which the body's whole surface is visible.
void cut_at_level(std::vector<dvec3>& points, double level, const dvec3& pole) {
  for (dvec3& p : points) {
    if (p.y <= level) continue;
    const double share = (level - pole.y) / (p.y - pole.y);
    p = {pole.x + (p.x - pole.x) * share, level, pole.z + (p.z - pole.z) * share};
  }
}

}  // namespace

Mesh make_ice(const IceBlock& block) {
  const Shell shell = make_shell(block);
  Mesh mesh;
  append_surface(mesh, shell.grid, surface_points(shell.grid, shell.outer), false);
  if (block.hollow) append_surface(mesh, shell.grid, surface_points(shell.grid, shell.cavity), true);
  add_smooth_normals(mesh);
  return mesh;
}

glm::dvec2 cavity_levels(const IceBlock& block) {
  const SoftSolid cavity = cavity_solid(block);
  return {-surface_distance(cavity, {0, -1, 0}), surface_distance(cavity, {0, 1, 0})};
}

Mesh make_ice_liquid(const IceBlock& block, double level, double wall) {
  if (!block.hollow) throw GenerateError("cavity: wanted one for the liquid to be in");
  const Shell shell = make_shell(block);
  const glm::dvec2 range = cavity_levels(block);
  if (!(level > range.x && level < range.y))
    throw GenerateError("level: wanted between the cavity's bottom and top");
  std::vector<double> ends;
  for (std::size_t i = 0; i < shell.outer.size(); i++)
    ends.push_back(shell.cavity[i] + (shell.outer[i] - shell.cavity[i]) * wall);
  std::vector<dvec3> points = surface_points(shell.grid, ends);
  cut_at_level(points, level, {0, std::min(0.0, (level + range.x) * 0.5), 0});
  Mesh mesh;
  append_surface(mesh, shell.grid, points, false);
  add_smooth_normals(mesh);
  return mesh;
}

}  // namespace sundog
