// Whether meshes are surfaces of solids.
#include <algorithm>

#include "catch.h"
#include "scene/mesh_faults.h"

using namespace sundog;

namespace {

/// Eight corners about `center`; faces outwards.
Mesh cube(glm::vec3 center, float half) {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.positions.push_back(center + half * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  const glm::uvec4 faces[] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const glm::uvec4& f : faces) {
    mesh.triangles.emplace_back(f.x, f.y, f.z);
    mesh.triangles.emplace_back(f.x, f.z, f.w);
  }
  return mesh;
}

Mesh turned(Mesh mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  return mesh;
}

Mesh joined(Mesh mesh, const Mesh& other) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  mesh.positions.values().insert(mesh.positions.values().end(), other.positions.begin(),
                                 other.positions.end());
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
  return mesh;
}

/// Each triangle with corners of its own, as STL has them.
Mesh unshared(const Mesh& mesh) {
  Mesh result;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto first = static_cast<unsigned>(result.positions.size());
    for (int k = 0; k < 3; ++k) result.positions.push_back(mesh.positions[t[k]]);
    result.triangles.emplace_back(first, first + 1, first + 2);
  }
  return result;
}

void check(const Mesh& mesh, std::size_t open, std::size_t turned_edges, std::size_t parts,
           std::size_t inside_out) {
  for (const Mesh& form : {mesh, unshared(mesh)}) {
    const MeshFaults faults = find_faults(form);
    CHECK(faults.open_edges == open);
    CHECK(faults.turned_edges == turned_edges);
    CHECK(faults.parts == parts);
    CHECK(faults.inside_out == inside_out);
  }
}

}  // namespace

TEST_CASE("a closed mesh that faces outwards has no fault") {
  check(cube({5, 0, 0}, 1), 0, 0, 1, 0);
  check({}, 0, 0, 0, 0);
}

TEST_CASE("a mesh without a triangle is open at its three edges") {
  Mesh mesh = cube({0, 0, 0}, 1);
  mesh.triangles.values().pop_back();
  check(mesh, 3, 0, 0, 0);
}

TEST_CASE("a turned triangle is distinguished from an opening") {
  Mesh mesh = cube({0, 0, 0}, 1);
  std::swap(mesh.triangles[0].y, mesh.triangles[0].z);
  check(mesh, 0, 3, 0, 0);
}

TEST_CASE("a mesh that faces inwards is inside out, a hollow is not") {
  check(turned(cube({1e4f, 0, 0}, 1)), 0, 0, 1, 1);
  check(joined(cube({0, 0, 0}, 2), turned(cube({0, 0, 0}, 1))), 0, 0, 2, 0);
  check(joined(cube({0, 0, 0}, 2), turned(cube({9, 0, 0}, 1))), 0, 0, 2, 1);
}
