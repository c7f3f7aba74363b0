// Closed meshes have no gaps: a ray that starts inside meets the surface, also where it runs through an edge
// or a vertex.
#include <random>

#include "bench/rays/ray_tracer.h"
#include "catch.h"
#include "devices.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

using glm::vec3;

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }

/// A bumpy sphere whose poles are one point each.
Mesh closed_mesh(int rings) {
  Mesh mesh = bumpy_sphere(rings);
  const std::size_t ring = mesh.positions.size() / static_cast<std::size_t>(rings + 1);
  for (std::size_t i = 0; i < ring; ++i) {
    mesh.positions[i] = mesh.positions[0];
    mesh.positions[mesh.positions.size() - 1 - i] = mesh.positions.back();
  }
  return mesh;
}

/// Vertices, points on edges and midpoints of edges of the mesh.
std::vector<vec3> edge_points(const Mesh& mesh, std::size_t count, std::mt19937& random) {
  std::vector<vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::uvec3& triangle = mesh.triangles[random() % mesh.triangles.size()];
    const vec3 a = mesh.positions[triangle[static_cast<int>(i % 3)]],
               b = mesh.positions[triangle[static_cast<int>((i + 1) % 3)]];
    const float w = i % 4 == 0 ? 0.0f : i % 4 == 1 ? 0.5f : uniform(random);
    points.push_back(a + w * (b - a));
  }
  return points;
}

Ray ray_to(const vec3& from, const vec3& to, bool unit) {
  const vec3 d = unit ? glm::normalize(to - from) : to - from;
  return {from.x, from.y, from.z, 0, d.x, d.y, d.z, std::numeric_limits<float>::infinity()};
}

/// From the centre, from points inside, from vertices' neighbourhood, towards edges and vertices.
std::vector<Ray> rays_from_inside(const Mesh& mesh, std::size_t count) {
  std::mt19937 random(5);
  std::vector<Ray> rays;
  for (const vec3& target : edge_points(mesh, count, random)) {
    const std::size_t i = rays.size();
    vec3 from(0);
    if (i % 3 == 1) from = 0.7f * (vec3(uniform(random), uniform(random), uniform(random)) - 0.5f);
    if (i % 3 == 2) from = 0.5f * mesh.positions[random() % mesh.positions.size()];
    rays.push_back(ray_to(from, target, i % 2 == 0));
  }
  return rays;
}

}  // namespace

TEST_CASE("rays from inside a closed mesh towards its edges and vertices never slip through") {
  on_every_device([&](const DeviceInfo& info) {
    const std::size_t count = info.label() == test_devices().front().label() ? 2000000 : 40000;
    Mesh mesh = closed_mesh(100);
    const std::vector<Ray> rays = rays_from_inside(mesh, count);
    Device device(info);
    RayTracer tracer(device, compile(scene_of(std::move(mesh))));
    std::size_t leaks = 0;
    for (const Hit& hit : tracer.trace(rays)) leaks += hit.instance == NO_INSTANCE;
    CHECK(leaks == 0);
    leaks = 0;
    for (const u32 occluded : tracer.occlusion(rays)) leaks += !occluded;
    CHECK(leaks == 0);
  });
}
