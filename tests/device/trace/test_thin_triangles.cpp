// Rays beside a triangle that is edge-on or has no area do not hit it.
#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include "bench/rays/ray_tracer.h"
#include "catch.h"
#include "each_tracer.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A floor of squares in the plane through 0 of two directions along no axis.
constexpr int squares = 40;
const glm::vec3 floor_u = glm::normalize(glm::vec3(3, 1, -2)), floor_v = glm::normalize(glm::vec3(1, -1, 1));

SceneDescription turned_floor() {
  Mesh mesh;
  for (int i = 0; i <= squares; ++i)
    for (int j = 0; j <= squares; ++j)
      mesh.positions.push_back(0.05f * (static_cast<float>(i - squares / 2) * floor_u +
                                        static_cast<float>(j - squares / 2) * floor_v));
  const auto index = [](int i, int j) { return static_cast<unsigned>(i * (squares + 1) + j); };
  for (int i = 0; i < squares; ++i)
    for (int j = 0; j < squares; ++j) {
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i, j + 1));
      mesh.triangles.emplace_back(index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
    }
  return scene_of(std::move(mesh));
}

/// In the floor's plane but for rounding: any that is hit is seen edge on.
std::vector<Ray> rays_in_floor(std::size_t count) {
  std::mt19937 random(9);
  const auto coordinate = [&] { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; };
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const float ou = coordinate(), ov = coordinate(), du = coordinate(), dv = coordinate();
    const glm::vec3 o = 2.0f * (ou * floor_u + ov * floor_v), d = du * floor_u + dv * floor_v;
    rays.push_back({o.x, o.y, o.z, 0, d.x, d.y, d.z, infinity});
  }
  return rays;
}

/// How far the point at the hit lies outside of the triangle's box.
float distance_to_triangle(const SceneDescription& scene, const Ray& ray, const Hit& hit) {
  const Mesh& mesh = scene.meshes[0];
  const glm::uvec3& corners = mesh.triangles[hit.prim];
  const glm::vec3 &a = mesh.positions[corners.x], &b = mesh.positions[corners.y],
                  &c = mesh.positions[corners.z];
  const glm::vec3 p = glm::vec3(ray.ox, ray.oy, ray.oz) + hit.t * glm::vec3(ray.dx, ray.dy, ray.dz);
  return glm::length(p - glm::clamp(p, glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)));
}

/// Points, lines of corners in twos and in threes, none along an axis.
SceneDescription triangles_without_area() {
  Mesh mesh;
  std::mt19937 random(2);
  const auto coordinate = [&] { return static_cast<float>(random() % 2001) * 0x1p-10f - 1.0f; };
  for (unsigned i = 0; i < 600; ++i) {
    const float x = coordinate(), y = coordinate(), z = coordinate();
    const glm::vec3 a(x, y, z), b = 0.5f * glm::vec3(y, z, -x);
    const std::array<glm::vec3, 3> corners = i % 3 == 0   ? std::array{a, a, a}
                                             : i % 3 == 1 ? std::array{a, b, a}
                                                          : std::array{a, a + b, a + 2.0f * b};
    mesh.positions.values().insert(mesh.positions.values().end(), corners.begin(), corners.end());
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return scene_of(std::move(mesh));
}

/// Along the z axis and across it, through points of the lines.
std::vector<Ray> rays_at_lines(const Mesh& mesh) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k <= 16; ++k) {
      const glm::vec3 &a = mesh.positions[3 * i], &b = mesh.positions[3 * i + 1];
      const glm::vec3 p = a + 0x1p-4f * static_cast<float>(k) * (b - a);
      const glm::vec3 o = i % 2 ? glm::vec3(p.x, p.y, 4) : glm::vec3(0.3f, 0.2f, 4);
      rays.push_back({o.x, o.y, o.z, 0, p.x - o.x, p.y - o.y, p.z - o.z, infinity});
    }
  return rays;
}

}  // namespace

TEST_CASE("rays in the plane of a floor meet its triangles where those are") {
  const SceneDescription scene = turned_floor();
  const std::vector<Ray> rays = rays_in_floor(40'000);
  for_each_tracer(scene, [&](const CompiledScene&, RayTracer& tracer, bool coherent) {
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    std::size_t met = 0, beside = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].instance == NO_INSTANCE) continue;
      ++met;
      beside += distance_to_triangle(scene, rays[i], hits[i]) > 0.08f;  // more than a triangle's length
    }
    CHECK(met > rays.size() / 50);
    CHECK(beside == 0);
  });
}

TEST_CASE("triangles without area are not hit") {
  const SceneDescription scene = triangles_without_area();
  const std::vector<Ray> rays = rays_at_lines(scene.meshes[0]);
  for_each_tracer(scene, [&](const CompiledScene&, RayTracer& tracer, bool coherent) {
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    const auto met = [](const Hit& hit) { return hit.instance != NO_INSTANCE; };
    CHECK(std::count_if(hits.begin(), hits.end(), met) == 0);
  });
}
