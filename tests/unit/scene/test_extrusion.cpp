// Extrusions and terrains: closed or level where they should be, of the right volume and range.
#include <algorithm>
#include <cmath>

#include "catch.h"
#include "mesh_volume.h"
#include "scene/mesh_faults.h"
#include "scene/procedural/extrusion.h"
#include "scene/procedural/ice_block.h"
#include "scene/procedural/terrain.h"

using namespace sundog;
using glm::dvec3;

TEST_CASE("an extrusion is closed and has its outline's area times its height, whichever way that runs") {
  // An L with a rounded outer corner.
  Extrusion extrusion{.outline = {{{0, 0}}, {{3, 0}, 0.5}, {{3, 1}}, {{1, 1}}, {{1, 2}}, {{0, 2}}},
                      .height = 0.5,
                      .facets = 512};
  const double area = 4 - 0.25 * (1 - 3.14159265358979 / 4);
  for (int way = 0; way < 2; ++way) {
    const Mesh mesh = make_extrusion(extrusion);
    const MeshFaults faults = find_faults(mesh);
    CHECK(faults.open_edges == 0);
    CHECK(faults.turned_edges == 0);
    CHECK(faults.inside_out == 0);
    CHECK(volume(mesh) == Approx(area * 0.5).epsilon(1e-4));
    std::ranges::reverse(extrusion.outline);
  }
  extrusion.outline = {{{0, 0}}, {{1, 1}}, {{1, 0}}, {{0, 1}}};
  CHECK_THROWS_WITH(make_extrusion(extrusion), ContainsSubstring("crosses itself after ["));
}

TEST_CASE("a terrain has its size and height, faces up, and is another one for another seed") {
  Terrain terrain{.size = {8, 4}, .height = 1.5, .cells = 64};
  const Mesh mesh = make_terrain(terrain);
  CHECK(mesh.triangles.size() == 2 * 64 * 32);
  glm::vec3 low = mesh.positions[0], high = low;
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  CHECK(low == glm::vec3(-4, 0, -2));
  CHECK(high == glm::vec3(4, 1.5f, 2));
  for (const auto& t : mesh.triangles) {
    const glm::vec3 normal =
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    CHECK(normal.y > 0);
    CHECK(glm::dot(normal, mesh.normals[t.x]) > 0);
  }
  terrain.seed = 2;
  CHECK_FALSE(make_terrain(terrain).positions == mesh.positions);
}

TEST_CASE("a sweep is level, upright and round where it should be, and its normals point at the scene") {
  const Sweep sweep{.size = {6, 4}, .height = 3, .radius = 1};
  const Mesh mesh = make_sweep(sweep);
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    area += 0.5 * glm::length(normal);
    CHECK(glm::dot(normal, glm::dvec3(mesh.normals[t.x])) > 0);
  }
  CHECK(area == Approx(6 * (3 + 2 + std::acos(-1.0) / 2)).epsilon(1e-4));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 p(mesh.positions[i]), n(mesh.normals[i]);
    if (p.z >= -1) {
      CHECK(p.y == 0);
      CHECK(n.y == Approx(1));
    } else if (p.y < 1) {
      CHECK(glm::length(p + 1.0 * n - dvec3(p.x, 1, -1)) < 1e-6);
    } else {
      CHECK(p.z == -2);
    }
  }
  CHECK_THROWS_WITH(make_sweep({.size = {6, 4}, .height = 3, .radius = 3.5}), ContainsSubstring("radius"));
}

TEST_CASE("a terrain by a formula has its values as heights, and refuses what is no height") {
  const Mesh mesh = make_terrain(
      {.size = {4, 2}, .cells = 32, .formula = lower_pattern({"r = p.x * p.x\n0.25 * r - p.z", {}})});
  for (const glm::vec3& p : mesh.positions) CHECK(p.y == Approx(0.25f * p.x * p.x - p.z).margin(1e-6));
  CHECK_THROWS_WITH(make_terrain({.formula = lower_pattern({"1e9 * p.x", {}})}),
                    ContainsSubstring("no height up to 1e6"));
}
