// Rays that are none hit nothing and disturb no other of their batch; very short and very long directions are
// directions. For each tracer: sixteen rays together, rays alone, and the compact one.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "bench/rays/check_hits.h"
#include "bench/rays/ray_tracer.h"
#include "catch.h"
#include "each_tracer.h"
#include "every_kind.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float no_number = std::nanf("");

SceneDescription lone_mesh() { return scene_of(bumpy_sphere(12)); }

/// A solid of each kind, turned meshes, a plane.
SceneDescription all_shapes() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 5}, {0, 0, 0});
  const int white = scenes::add_white(scene);
  scene.meshes = {bumpy_sphere(12)};
  const glm::dmat4 one(1);
  scenes::place(scene, MeshShape{0}, white);
  scenes::place(scene, MeshShape{0}, white, glm::scale(glm::rotate(one, 0.7, {1, 2, 3}), glm::dvec3(1.2)));
  const std::vector<Shape> solids = every_bounded_solid();
  for (std::size_t i = 0; i < solids.size(); ++i)
    scenes::place(
        scene, solids[i], white,
        glm::scale(glm::translate(one, {0.4 * std::cos(i), 0.4 * std::sin(i), 0}), glm::dvec3(0.3)));
  scenes::place(scene, PlaneShape{}, white, glm::translate(one, {0, -1.1, 0}));
  return scene;
}

/// Towards the middle of the scene.
Ray good_ray(std::size_t i) {
  const float x = 0.03f * static_cast<float>(i % 16), y = 0.02f * static_cast<float>(i % 7);
  return {x, y, 4, 0, -0.1f * x, 0.01f, -1, infinity};
}

using Change = void (*)(Ray&);

/// Changes after which a ray hits nothing.
const std::vector<Change> no_rays = {
    [](Ray& r) { r.ox = no_number; },
    [](Ray& r) { r.oy = no_number; },
    [](Ray& r) { r.oz = no_number; },
    [](Ray& r) { r.dx = no_number; },
    [](Ray& r) { r.dy = no_number; },
    [](Ray& r) { r.dz = no_number; },
    [](Ray& r) { r.ox = infinity; },
    [](Ray& r) { r.oy = -infinity; },
    [](Ray& r) { r.oz = infinity; },
    [](Ray& r) { r.dx = infinity; },
    [](Ray& r) { r.dy = -infinity; },
    [](Ray& r) { r.dz = -infinity; },
    [](Ray& r) { r.dx = r.dy = r.dz = -infinity; },
    [](Ray& r) { r.dx = r.dy = r.dz = 0; },
    [](Ray& r) { r.dx = r.dy = r.dz = -0.0f; },
    [](Ray& r) { r.t_min = no_number; },
    [](Ray& r) { r.t_max = no_number; },
    [](Ray& r) { r.t_min = infinity; },
    [](Ray& r) { r.t_max = 0; },
    [](Ray& r) { r.t_max = -1; },
    [](Ray& r) { r.t_max = -infinity; },
    [](Ray& r) { r.ox = r.oy = r.oz = r.dx = r.dy = r.dz = no_number; },
};

/// Each change in a batch of good rays, at a place of its own, and in a batch of nothing else.
std::vector<Ray> with_changes(const std::vector<Change>& changes, std::vector<bool>& changed) {
  std::vector<Ray> rays;
  for (std::size_t c = 0; c < changes.size(); ++c)
    for (const bool all : {false, true})
      for (std::size_t i = 0; i < 16; ++i) {
        rays.push_back(good_ray(i));
        changed.push_back(all || i == c % 16);
        if (changed.back()) changes[c](rays.back());
      }
  return rays;
}

void check_no_rays(const SceneDescription& scene) {
  for_each_tracer(scene, [](const CompiledScene&, RayTracer& tracer, bool coherent) {
    std::vector<bool> changed;
    const std::vector<Ray> rays = with_changes(no_rays, changed);
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    const std::vector<u32> occluded = tracer.occlusion(rays, coherent);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i / 32, i % 32);
      REQUIRE((hits[i].instance != NO_INSTANCE) == !changed[i]);
      REQUIRE((occluded[i] != 0) == !changed[i]);
    }
  });
}

void scale_direction(Ray& ray, float by) { ray.dx *= by, ray.dy *= by, ray.dz *= by; }
void scale_origin(Ray& ray, float by) {
  const float far = by / 4;  // the ray begins at about -by times its direction
  ray.ox = -far * ray.dx, ray.oy = -far * ray.dy, ray.oz = -far * ray.dz;
}

bool all_finite(const Hit& hit) {
  return std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && std::isfinite(hit.ng_x) &&
         std::isfinite(hit.ng_y) && std::isfinite(hit.ng_z);
}

}  // namespace

TEST_CASE("rays that are none hit nothing: one mesh") { check_no_rays(lone_mesh()); }
TEST_CASE("rays that are none hit nothing: all shapes") { check_no_rays(all_shapes()); }

TEST_CASE("directions of any length that a float can square hit as unit ones do") {
  for_each_tracer(all_shapes(), [](const CompiledScene& flat, RayTracer& tracer, bool coherent) {
    std::vector<bool> changed;
    const std::vector<Ray> rays =
        with_changes({[](Ray& r) { scale_direction(r, 1e-9f); }, [](Ray& r) { scale_direction(r, 1e-5f); },
                      [](Ray& r) { scale_direction(r, 1e5f); }, [](Ray& r) { scale_direction(r, 1e9f); }},
                     changed);
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    const std::vector<u32> occluded = tracer.occlusion(rays, coherent);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i / 32, i % 32, hits[i].t, hits[i].instance);
      CHECK(hits[i].instance != NO_INSTANCE);
      CHECK(is_right(flat, rays[i], hits[i]));
      CHECK(is_right(flat, rays[i], occluded[i] != 0));
    }
  });
}

TEST_CASE("denormal and huge directions and origins give a finite hit or none") {
  for_each_tracer(all_shapes(), [](const CompiledScene&, RayTracer& tracer, bool coherent) {
    std::vector<bool> changed;
    const std::vector<Ray> rays = with_changes(
        {[](Ray& r) { scale_direction(r, 1e-40f); }, [](Ray& r) { scale_direction(r, 1e-30f); },
         [](Ray& r) { scale_direction(r, 1e30f); }, [](Ray& r) { scale_direction(r, 3e38f); },
         [](Ray& r) { scale_origin(r, 1e10f); }, [](Ray& r) { scale_origin(r, 1e20f); },
         [](Ray& r) { scale_origin(r, 1e38f); }, [](Ray& r) { r.ox = 1e-40f, r.dx = 1e-42f; },
         [](Ray& r) { r.dx = 3e38f; }, [](Ray& r) { r.t_min = 1e-42f; }, [](Ray& r) { r.t_max = 3e38f; }},
        changed);
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i / 32, i % 32);
      if (hits[i].instance == NO_INSTANCE)
        CHECK(changed[i]);
      else
        CHECK(all_finite(hits[i]));
    }
  });
}

TEST_CASE("an interval that ends at a hit holds it, one that begins there does not") {
  for_each_tracer(lone_mesh(), [](const CompiledScene&, RayTracer& tracer, bool coherent) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < 640; ++i) rays.push_back(good_ray(i));
    for (std::size_t i = 0; i < rays.size(); ++i) scale_direction(rays[i], 1 + 0.37f * static_cast<float>(i));
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    const auto trace_within = [&](const auto& set_interval) {
      std::vector<Ray> changed = rays;
      for (std::size_t i = 0; i < rays.size(); ++i) set_interval(changed[i], hits[i].t);
      return tracer.trace(changed, coherent);
    };
    const std::vector<Hit> ends = trace_within([](Ray& r, float t) { r.t_max = t; }),
                           ends_before =
                               trace_within([](Ray& r, float t) { r.t_max = std::nextafter(t, 0.0f); }),
                           begins = trace_within([](Ray& r, float t) { r.t_min = t; }),
                           begins_before =
                               trace_within([](Ray& r, float t) { r.t_min = std::nextafter(t, 0.0f); });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i, hits[i].t);
      REQUIRE(ends[i].t == hits[i].t);
      REQUIRE(ends[i].prim == hits[i].prim);
      REQUIRE(begins_before[i].t == hits[i].t);
      REQUIRE(ends_before[i].instance == NO_INSTANCE);
      REQUIRE(begins[i].t > hits[i].t);
    }
  });
}

TEST_CASE("rays meet a torus also at its outer equator") {
  SceneDescription scene = scenes::line_of_sight({0, 0, 5}, {0, 0, 0});
  scenes::place(scene, TorusShape{1, 0.6}, scenes::add_white(scene));
  // From within the tube to the equator, and from there outwards to it again.
  std::vector<Ray> rays;
  for (int i = 0; i < 20'000; i += 4) {
    const float angle = 0.001f * static_cast<float>(i), turn = 0.00037f * static_cast<float>(i % 2000 - 1000);
    const glm::vec3 from(1.1f * std::cos(angle), 0.01f * static_cast<float>(i % 7), 1.1f * std::sin(angle)),
        to(1.6f * std::cos(angle + turn), 1e-4f * static_cast<float>(i % 5 - 2),
           1.6f * std::sin(angle + turn)),
        d = glm::normalize(to - from), outside = from + 3.0f * d;
    rays.push_back({from.x, from.y, from.z, 0, d.x, d.y, d.z, infinity});
    rays.push_back({outside.x, outside.y, outside.z, 0, -d.x, -d.y, -d.z, infinity});
  }
  for_each_tracer(scene, [&](const CompiledScene& flat, RayTracer& tracer, bool coherent) {
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) wrong += !is_right(flat, rays[i], hits[i]);
    CHECK(wrong == 0);
  });
}
