// Nearest hits against Embree's: 100,000 rays of each kind, on a mesh like a scan and on one of degenerate
// and touching triangles.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "bench/rays/ray_tracer.h"
#include "catch.h"
#include "devices.h"
#include "embree_peer.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

using glm::vec3;

constexpr std::size_t ray_count = 100'000;

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }

vec3 on_sphere(std::mt19937& random, float radius) {
  const float z = 2 * uniform(random) - 1, angle = 6.2831853f * uniform(random), r = std::sqrt(1 - z * z);
  return radius * vec3(r * std::cos(angle), r * std::sin(angle), z);
}

Ray ray(const vec3& o, const vec3& d) {
  return {o.x, o.y, o.z, 0, d.x, d.y, d.z, std::numeric_limits<float>::infinity()};
}

vec3 point_of(const Mesh& mesh, std::mt19937& random, bool on_edge) {
  const glm::uvec3& corners = mesh.triangles[random() % mesh.triangles.size()];
  const float u = uniform(random), v = on_edge ? 0 : (1 - u) * uniform(random);
  const vec3 a = mesh.positions[corners[0]];
  return a + u * (mesh.positions[corners[1]] - a) + v * (mesh.positions[corners[2]] - a);
}

enum class Kind { random, grazing, axis_parallel, edge };

std::vector<Ray> make_rays(Kind kind, const Mesh& mesh) {
  std::mt19937 random(11);
  std::vector<Ray> rays;
  while (rays.size() < ray_count) {
    const vec3 target = point_of(mesh, random, kind == Kind::edge);
    const vec3 from = on_sphere(random, 3);
    if (kind == Kind::random) {
      rays.push_back(ray(from, glm::normalize(on_sphere(random, 1) - from)));
    } else if (kind == Kind::grazing) {  // past a point of the surface, nearly in its tangent plane
      const vec3 along =
          glm::normalize(glm::cross(glm::normalize(target + vec3(1e-3f)), on_sphere(random, 1)));
      rays.push_back(ray(target * (1 + 1e-4f * (uniform(random) - 0.5f)) - 3.0f * along, along));
    } else if (kind == Kind::axis_parallel) {
      vec3 d(random() % 2 ? 0.0f : -0.0f);  // zeros of either sign
      const int axis = static_cast<int>(random() % 3);
      d[axis] = random() % 2 ? 1.0f : -1.0f;
      rays.push_back(ray(target - 3.0f * d, d));
    } else {
      rays.push_back(ray(from, target - from));
    }
  }
  return rays;
}

// Triangles without area, slivers, doubles and a flat sheet, among ordinary ones.
Mesh degenerate_mesh() {
  Mesh mesh = random_triangles(2000, 0.2f, 3);
  const std::size_t ordinary = mesh.triangles.size();
  for (std::size_t i = 0; i < ordinary; i += 7) {
    const glm::uvec3 t = mesh.triangles[i];
    mesh.triangles.push_back({t[0], t[0], t[1]});
    mesh.triangles.push_back({t[2], t[2], t[2]});
    mesh.triangles.push_back(t);
  }
  const auto first = static_cast<unsigned>(mesh.positions.size());
  for (int i = 0; i <= 20; ++i) {
    mesh.positions.push_back({-1 + 0.1f * static_cast<float>(i), 0.25f, -1});
    mesh.positions.push_back({-1 + 0.1f * static_cast<float>(i), 0.25f, 1});
  }
  for (unsigned i = 0; i < 20; ++i) {
    mesh.triangles.push_back({first + 2 * i, first + 2 * i + 1, first + 2 * i + 2});
    mesh.triangles.push_back({first + 2 * i + 1, first + 2 * i + 3, first + 2 * i + 2});
  }
  return mesh;
}

// On the rim of its triangle, where rounding decides whether a silhouette or an open edge is hit: both
// answers are right. (That nothing slips through an edge behind which the surface continues is
// test_traverse_watertight's.)
bool on_rim(float u, float v) { return std::min({u, v, 1 - u - v}) < 1e-4f; }

// Rays of which the two see different things off the rim of the nearer hit: one hits and the other does not,
// or t differs by more than rounding.
std::size_t disagreements(const std::vector<Hit>& ours, const std::vector<EmbreeHit>& theirs) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const bool hit = ours[i].instance != NO_INSTANCE, expected = theirs[i].prim != NO_PRIM;
    const float t = hit ? ours[i].t : std::numeric_limits<float>::infinity();
    const float t_expected = expected ? theirs[i].t : std::numeric_limits<float>::infinity();
    if (hit == expected && (!hit || std::abs(t - t_expected) <= 1e-5f * std::max(1.0f, t_expected))) continue;
    const bool rim = t < t_expected ? on_rim(ours[i].u, ours[i].v) : on_rim(theirs[i].u, theirs[i].v);
    count += !rim;
  }
  return count;
}

void compare(const Mesh& mesh, std::size_t allowed) {
  const SceneDescription scene = scene_of(mesh);
  const CompiledScene flat = compile(scene);
  const EmbreePeer embree(scene, {.robust = true});
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    RayTracer tracer(device, flat);
    for (const Kind kind : {Kind::random, Kind::grazing, Kind::axis_parallel, Kind::edge}) {
      std::vector<Ray> rays = make_rays(kind, mesh);
      if (info.native_vector_width <= 1) rays.resize(ray_count / 20);  // llvmpipe: 50 times slower
      std::vector<EmbreeHit> theirs(rays.size());
      embree.intersect(rays, theirs, 1);
      const std::vector<Hit> ours = tracer.trace(rays);
      const std::vector<u32> occluded = tracer.occlusion(rays);
      CAPTURE(static_cast<int>(kind), disagreements(ours, theirs));
      CHECK(disagreements(ours, theirs) <= allowed);
      std::size_t hits = 0, any_differs = 0;
      for (std::size_t i = 0; i < ours.size(); ++i) {
        hits += ours[i].instance != NO_INSTANCE;
        any_differs += (ours[i].instance != NO_INSTANCE) != (occluded[i] != 0);
      }
      CHECK(hits > rays.size() / 10);
      CHECK(any_differs == 0);
    }
  });
}

}  // namespace

// Where a ray grazes the silhouette or runs in a triangle's plane, rounding decides, and both answers are
// right: a few in 100,000.
TEST_CASE("nearest hits on a mesh like a scan are Embree's") { compare(bumpy_sphere(90), 40); }
TEST_CASE("nearest hits on degenerate and doubled triangles are Embree's") { compare(degenerate_mesh(), 40); }

TEST_CASE("nearest hits of meshes in several places among balls are Embree's") {
  SceneDescription scene = scene_of(bumpy_sphere(30));
  const Object mesh = scene.objects[0];
  std::mt19937 random(4);
  const auto coordinate = [&] { return 4e-3 * static_cast<double>(random() % 1000) - 2; };
  for (int i = 0; i < 60; ++i) {
    Object object = mesh;
    if (i % 6) object.shape = SphereShape{0.3};
    object.world_from_object =
        glm::rotate(glm::translate(dmat4(1), {coordinate(), coordinate(), coordinate()}), 0.1 * i, {1, 2, 0});
    scene.objects.push_back(object);
  }
  const CompiledScene flat = compile(scene);
  const EmbreePeer embree(scene, {.robust = true});
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    RayTracer tracer(device, flat);
    std::vector<Ray> rays = make_rays(Kind::random, scene.meshes[0]);
    if (info.native_vector_width <= 1) rays.resize(ray_count / 20);
    std::vector<EmbreeHit> theirs(rays.size());
    embree.intersect(rays, theirs, 1);
    const std::vector<Hit> ours = tracer.trace(rays);
    std::size_t hits = 0, differ = 0, other = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const bool hit = ours[i].instance != NO_INSTANCE, expected = theirs[i].prim != NO_PRIM;
      hits += hit;
      differ +=
          hit != expected || (hit && std::abs(ours[i].t - theirs[i].t) > 1e-5f * std::max(1.0f, ours[i].t));
      other += hit && expected && flat.instances[ours[i].instance].object != theirs[i].object;
    }
    CHECK(hits > rays.size() / 4);
    CHECK(differ <= rays.size() / 5000);
    CHECK(other <= rays.size() / 5000);
  });
}
