// Hits on every solid against the plain tracer's, which shares no code with the kernels: where, and with
// which normal.
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "bench/plain/tracer.h"
#include "bench/rays/check_hits.h"
#include "catch.h"
#include "each_tracer.h"
#include "every_kind.h"
#include "scenes.h"

using namespace sundog;
using glm::vec3;

namespace {

vec3 in_cube(std::mt19937& random) {
  vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(random() >> 8) * 0x1p-23f - 1;
  return p;
}

void add_small_mesh(SceneDescription& scene, int material) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  scenes::place(scene, MeshShape{0}, material);
}

/// Each solid with several parameters, turned and squeezed; more than are tried one after another, beside a
/// small mesh.
SceneDescription crowd_of_solids() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
  const int white = scenes::add_white(scene);
  const std::vector<Shape> shapes = solids_of_many_sizes();
  for (int i = 0; i < 2 * static_cast<int>(shapes.size()); ++i) {
    glm::dmat4 at = glm::translate(glm::dmat4(1), glm::dvec3(i % 3, i / 3 % 3, i / 9) - 1.0);
    if (i % 5) at = glm::rotate(at, 0.7 * i, glm::dvec3(1, 2, i));
    at = glm::scale(at, 0.4 * glm::dvec3(1, i % 4 ? 1 : 0.6, 1));
    scenes::place(scene, shapes[static_cast<std::size_t>(i) % shapes.size()], white, at);
  }
  add_small_mesh(scene, white);
  scenes::place(scene, PlaneShape{}, white, glm::translate(glm::dmat4(1), {0, -1.7, 0}));
  return scene;
}

/// Large solids of every shape, which are tested for many rays at once, beside a small mesh; no plane.
SceneDescription large_solids() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
  const int white = scenes::add_white(scene);
  const std::vector<Shape> shapes = every_bounded_solid();
  for (int i = 0; i < static_cast<int>(shapes.size()); ++i) {
    const glm::dmat4 at = glm::translate(glm::dmat4(1), 0.5 * glm::dvec3(i % 3, i / 3 % 3, i / 9) - 0.5);
    scenes::place(scene, shapes[static_cast<std::size_t>(i)], white, glm::scale(at, glm::dvec3(0.6)));
  }
  add_small_mesh(scene, white);
  return scene;
}

std::vector<Ray> rays_from_all_over(std::size_t count) {
  std::mt19937 random(11);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    // Some begin inside of the solids.
    const vec3 o = (rays.size() % 2 ? 1.2f : 4.0f) * in_cube(random), d = 1.3f * in_cube(random) - o;
    rays.push_back({o.x, o.y, o.z, 0, d.x, d.y, d.z, std::numeric_limits<float>::infinity()});
  }
  return rays;
}

void check_hits(const SceneDescription& scene) {
  const std::vector<Ray> rays = rays_from_all_over(4000);
  for_each_tracer(scene, [&](const CompiledScene& flat, RayTracer& tracer, bool coherent) {
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    int wrong = 0, turned = 0, met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& r = rays[i];
      const Hit& hit = hits[i];
      plain::Hit expected;
      const bool any =
          closest_hit(flat, {{r.ox, r.oy, r.oz}, {r.dx, r.dy, r.dz}, r.t_min, r.t_max}, expected);
      if (any != (hit.instance != NO_INSTANCE) ||
          (any && (expected.instance != hit.instance || std::abs(expected.t - hit.t) > 1e-4f))) {
        wrong += !is_right(flat, r, hit);
        continue;
      }
      if (!any) continue;
      ++met;
      const vec3 ng(hit.ng_x, hit.ng_y, hit.ng_z);
      turned += glm::dot(glm::normalize(ng), glm::normalize(expected.ng)) < 0.9999f;
    }
    CHECK(met > 1500);
    CHECK(wrong == 0);
    CHECK(turned <= met / 500);  // at edges
  });
}

}  // namespace

TEST_CASE("rays meet every solid where the plain tracer does, and with its normal") {
  check_hits(crowd_of_solids());
}

TEST_CASE("rays meet large solids of every shape beside a mesh, without a plane") {
  check_hits(large_solids());
}
