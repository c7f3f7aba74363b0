// The judge of tracers: right answers pass, also where rounding decides; wrong ones are found, each of them.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "bench/rays/check_hits.h"
#include "bench/rays/exact_tracer.h"
#include "catch.h"
#include "test_meshes.h"

using namespace sundog;
using glm::vec3;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A turned mesh, two spheres and a box, seen from two sides.
CompiledScene some_scene() {
  SceneDescription scene = scene_of(bumpy_sphere(24));
  const auto add = [&](const Shape& shape, const glm::dvec3& at) {
    Object object = scene.objects[0];
    object.shape = shape;
    object.world_from_object = glm::translate(dmat4(1), at);
    scene.objects.push_back(object);
  };
  scene.objects[0].world_from_object = glm::rotate(dmat4(1), 0.35, glm::dvec3(1, 2, 3));
  add(SphereShape{0.7}, {1.5, 0.3, 0});
  add(SphereShape{0.05}, {-0.9, 1.1, 0.5});
  add(BoxShape{{0.4, 0.3, 0.5}}, {-1.6, -0.2, 0.2});
  return compile(scene);
}

RaySet camera_rays(const CompiledScene& scene) {
  const TraceFunction trace = [&](std::span<const Ray> rays) {
    std::vector<Hit> hits(rays.size());
    for (Hit& hit : hits) hit.instance = NO_INSTANCE;
    return hits;
  };
  Viewpoint view = framing_viewpoint(scene, {0.3f, 0.2f, 1}, trace);
  view.tangent = 0.3f;
  return primary_rays(view, 96);
}

/// As a tracer without a flaw has it.
Answers exact_answers(const CompiledScene& scene, const RaySet& set) {
  Answers answers;
  for (const Ray& ray : set.rays) {
    const auto hit =
        trace_host(scene, {glm::dvec3(ray.ox, ray.oy, ray.oz), glm::dvec3(ray.dx, ray.dy, ray.dz),
                           double(ray.t_min), double(ray.t_max)});
    Hit answer{infinity, 0, 0, NO_PRIM, NO_INSTANCE, 0, 0, 0};
    if (hit) answer.t = static_cast<float>(hit->t), answer.instance = hit->instance;
    answers.hits.push_back(answer);
    answers.occluded.push_back(hit.has_value());
  }
  return answers;
}

}  // namespace

TEST_CASE("right answers pass the check, every ray is checked") {
  const CompiledScene scene = some_scene();
  RaySet set = camera_rays(scene);
  const Answers answers = exact_answers(scene, set);
  for (const bool any : {false, true}) {
    set.any = any;
    const HitCheck check = check_hits(scene, set, answers);
    CHECK(check.checked == set.rays.size());
    CHECK(check.hits > set.rays.size() / 5);
    CHECK(check.hits < set.rays.size());
    CHECK(check.differ == 0);
  }
}

TEST_CASE("each wrong answer is found") {
  const CompiledScene scene = some_scene();
  RaySet set = camera_rays(scene);
  const Answers right = exact_answers(scene, set);
  const auto falsified = [&](const auto& falsify) {
    Answers answers = right;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < set.rays.size(); i += 37)
      if (right.hits[i].instance != NO_INSTANCE) falsify(answers, i), ++changed;
    const HitCheck check = check_hits(scene, set, answers);
    CHECK(changed > 50);
    CHECK(check.differ + 2 >= changed);  // at a silhouette both answers are right
    CHECK(check.differ <= changed);
  };
  SECTION("a lost hit") {
    falsified([](Answers& a, std::size_t i) { a.hits[i].instance = NO_INSTANCE; });
  }
  SECTION("a distance that is too small") {
    falsified([](Answers& a, std::size_t i) { a.hits[i].t *= 0.999f; });
  }
  SECTION("a distance that is too great") {
    falsified([](Answers& a, std::size_t i) { a.hits[i].t *= 1.001f; });
  }
  SECTION("a distance that is no number") {
    falsified([](Answers& a, std::size_t i) { a.hits[i].t = std::nanf(""); });
  }
  SECTION("another instance") {
    falsified([](Answers& a, std::size_t i) { a.hits[i].instance ^= 1; });
  }
  SECTION("an instance that there is not") {
    falsified([](Answers& a, std::size_t i) { a.hits[i].instance = 99; });
  }
  SECTION("a shadow that is lost") {
    set.any = true;
    falsified([](Answers& a, std::size_t i) { a.occluded[i] = 0; });
  }
}

TEST_CASE("hits out of nothing are found") {
  const CompiledScene scene = some_scene();
  RaySet set = camera_rays(scene);
  Answers answers = exact_answers(scene, set);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < set.rays.size(); i += 11)
    if (answers.hits[i].instance == NO_INSTANCE) {
      answers.hits[i].instance = 0;
      answers.hits[i].t = 3;
      answers.occluded[i] = 1;
      ++changed;
    }
  for (const bool any : {false, true}) {
    set.any = any;
    const HitCheck check = check_hits(scene, set, answers);
    CHECK(check.differ + 2 >= changed);
    CHECK(check.differ <= changed);
  }
}

TEST_CASE("at a silhouette, at an edge and at the ends of its interval a ray may hit or miss") {
  Mesh square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  const CompiledScene scene = compile(scene_of(square));
  const auto ray = [](float x, float y, float t_max) { return Ray{x, y, 2, 0, 0, 0, -1, t_max}; };
  const Hit hit{2, 0, 0, 0, 0, 0, 0, 1}, none{0, 0, 0, NO_PRIM, NO_INSTANCE, 0, 0, 0};
  for (const Ray& either : {ray(1, 0.5f, infinity), ray(0.25f, 1, 9), ray(0.5f, 0.25f, 2)}) {
    CHECK(is_right(scene, either, hit));
    CHECK(is_right(scene, either, none));
    CHECK(is_right(scene, either, true));
    CHECK(is_right(scene, either, false));
  }
  // On the edge between the two triangles, behind which the surface continues, a ray hits.
  for (const Ray& met : {ray(0.5f, 0.5f, infinity), ray(0.25f, 0.5f, 2.001f)}) {
    CHECK(is_right(scene, met, hit));
    CHECK_FALSE(is_right(scene, met, none));
    CHECK_FALSE(is_right(scene, met, false));
  }
  for (const Ray& missed : {ray(1.001f, 0.5f, infinity), ray(0.5f, 0.5f, 1.999f)}) {
    CHECK_FALSE(is_right(scene, missed, hit));
    CHECK_FALSE(is_right(scene, missed, true));
    CHECK(is_right(scene, missed, none));
  }
}

TEST_CASE("where a ray grazes a surface near its border, rounding may move the hit far") {
  Mesh square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  const CompiledScene scene = compile(scene_of(square));
  constexpr float slope = 1e-3f;
  const Ray grazing{0.5f, 0.5f, 0.4999f * slope, 0, 1, 0, -slope, infinity};
  const auto hit_at = [](float t) { return Hit{t, 0, 0, 0, 0, 0, 0, 1}; };
  CHECK(is_right(scene, grazing, hit_at(0.4999f)));
  CHECK(is_right(scene, grazing, hit_at(0.4994f)));
  CHECK_FALSE(is_right(scene, grazing, hit_at(0.48f)));
  CHECK_FALSE(is_right(scene, grazing, hit_at(0.52f)));
}

TEST_CASE("a view is filled also where nothing is in the middle of the scene") {
  SceneDescription description = scene_of(bumpy_sphere(4));
  Object object = description.objects[0];
  description.objects.clear();
  const std::vector<vec3> centers = {{-3, 0, 0}, {3, 0, 0}};
  for (const vec3& center : centers) {
    object.shape = SphereShape{0.9};
    object.world_from_object = glm::translate(dmat4(1), glm::dvec3(center));
    description.objects.push_back(object);
  }
  const TraceFunction trace = [&](std::span<const Ray> rays) {
    std::vector<Hit> hits(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const vec3 o(rays[i].ox, rays[i].oy, rays[i].oz), d(rays[i].dx, rays[i].dy, rays[i].dz);
      hits[i].instance = NO_INSTANCE;
      for (const vec3& center : centers)
        if (glm::length(glm::cross(center - o, d)) < 0.9f) hits[i].instance = 0;
    }
    return hits;
  };
  const Viewpoint view = framing_viewpoint(compile(description), {0, 0, 1}, trace);
  const std::vector<Hit> hits = trace(primary_rays(view, 64).rays);
  const auto met = std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.instance == 0; });
  CHECK(met > 64 * 64 / 20);
}
