// Tangents of normal maps against those of surfaces that have them in closed form.
#include <compile/compiled_scene.h>

#include <cmath>
#include <numbers>

#include "catch.h"
#include "scenes.h"

using namespace sundog;

namespace {

constexpr double pi = std::numbers::pi;

dvec3 unpack(u32 bits) {
  const double x = (bits & 0xFFFF) * 2.0 / 65535 - 1, y = (bits >> 16 & 0x7FFF) * 2.0 / 32767 - 1;
  const double z = 1 - std::abs(x) - std::abs(y), fold = std::max(-z, 0.0);
  return glm::normalize(dvec3(x - std::copysign(fold, x), y - std::copysign(fold, y), z));
}

/// A grid over u and v whose points and normals are given.
template <class Point, class Normal>
Mesh grid(int n, bool mirrored, const Point& point, const Normal& normal) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double u = double(i) / n, v = 0.1 + 0.8 * j / n;
      mesh.positions.emplace_back(point(u, v));
      mesh.normals.emplace_back(normal(u, v));
      mesh.uvs.emplace_back(mirrored ? 1 - u : u, v);
    }
  for (u32 j = 0; j < u32(n); ++j)
    for (u32 i = 0; i < u32(n); ++i) {
      const u32 a = j * u32(n + 1) + i, b = a + u32(n + 1);
      mesh.triangles.emplace_back(a, b, a + 1);
      mesh.triangles.emplace_back(a + 1, b, b + 1);
    }
  return mesh;
}

CompiledScene with_normal_map(const Mesh& mesh) {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scene.meshes.push_back(mesh);
  scenes::place(scene, MeshShape{0}, scenes::add_white(scene));
  scene.textures.emplace_back().offset = {0.5, 0.5, 1, 1};
  scene.materials[0].textures.normal = 0;
  return compile(scene);
}

void check_tangents(const Mesh& mesh, bool mirrored, double tolerance) {
  const CompiledScene flat = with_normal_map(mesh);
  REQUIRE(flat.tangents.size() == 3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int corner = 0; corner < 3; ++corner) {
      const u32 packed = flat.tangents[3 * t + std::size_t(corner)];
      const dvec3 p(mesh.positions[mesh.triangles[t][corner]]);
      const dvec3 along = glm::normalize(dvec3(-p.z, 0, p.x)) * (mirrored ? -1.0 : 1.0);
      REQUIRE(glm::distance(unpack(packed), along) < tolerance);
    }
}

}  // namespace

TEST_CASE("tangents of a sphere and a torus go along the circles on which u grows") {
  const auto about = [](double u, double radius, double y) {
    return dvec3(radius * std::cos(2 * pi * u), y, radius * std::sin(2 * pi * u));
  };
  const auto sphere = [&](double u, double v) { return about(u, std::sin(pi * v), -std::cos(pi * v)); };
  const auto torus = [&](double u, double v) {
    return about(u, 1 + 0.25 * std::cos(2 * pi * v), 0.25 * std::sin(2 * pi * v));
  };
  const auto torus_normal = [&](double u, double v) {
    return about(u, std::cos(2 * pi * v), std::sin(2 * pi * v));
  };
  // At the seam u begins anew, and a corner has the triangles of one side alone.
  for (const bool mirrored : {false, true}) {
    check_tangents(grid(48, mirrored, sphere, sphere), mirrored, 0.08);
    check_tangents(grid(48, mirrored, torus, torus_normal), mirrored, 0.08);
  }
}

TEST_CASE("the frames of mirrored coordinates have another sign") {
  const auto flat = [](double u, double v) { return dvec3(u, 0, -v); };
  const auto up = [](double, double) { return dvec3(0, 1, 0); };
  for (const u32 packed : with_normal_map(grid(2, false, flat, up)).tangents) CHECK(packed >> 31 == 0);
  for (const u32 packed : with_normal_map(grid(2, true, flat, up)).tangents) CHECK(packed >> 31 == 1);
}
