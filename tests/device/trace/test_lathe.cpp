// Exact lathes against their profile's polynomials in double precision, on all kinds of rays.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "bench/plain/solids.h"
#include "bench/rays/check_hits.h"
#include "catch.h"
#include "each_tracer.h"
#include "scene/procedural/lathe.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;
using glm::vec3;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Case {
  const char* name;
  Lathe lathe;
};

std::vector<Case> lathes() {
  using enum procedural::ProfileCurve;
  return {{"glass",
           {{{{0, 0}},
             {{0, 0}},
             {{0.4, 0}},
             {{0.4, 0}},
             {{0.06, 0.1}},
             {{0.06, 0.1}},
             {{0.04, 0.8}},
             {{0.3, 1.02}},
             {{0.45, 1.3}},
             {{0.35, 1.9}},
             {{0.33, 1.9}},
             {{0.42, 1.3}},
             {{0.28, 1.06}},
             {{0, 0.95}}},
            spline}},
          {"bottle",
           {{{{0, 0.05}},
             {{0.3, 0}, 0.15},
             {{0.42, 0}, 0.05},
             {{0.42, 1.3}, 0.4},
             {{0.13, 1.62}, 0.3},
             {{0.13, 2.1}},
             {{0.1, 2.1}},
             {{0.1, 1.6}, 0.3},
             {{0.385, 1.28}, 0.4},
             {{0.385, 0.07}, 0.05},
             {{0, 0.12}}},
            lines}},
          {"ring", {{{{0.6, -0.2}}, {{0.9, -0.1}}, {{0.9, 0.3}}, {{0.5, 0.2}}, {{0.6, -0.2}}}, spline}},
          {"sheet", {{{{0.8, -0.5}}, {{0.3, 0}}, {{0.9, 0.6}}}, spline}}};
}

double uniform(std::mt19937& random) { return static_cast<double>(random()) * 0x1p-31 - 1; }
dvec3 in_cube(std::mt19937& random) { return {uniform(random), uniform(random), uniform(random)}; }

Ray ray_of(const dvec3& o, const dvec3& d) {
  const vec3 from(o), along(d);
  return {from.x, from.y, from.z, 0, along.x, along.y, along.z, infinity};
}

/// From all over; along and across the axis and through it; and along the surface, at most 1e-3 off it.
std::vector<Ray> rays_at(const LatheShape& shape, double middle) {
  std::mt19937 random(5);
  const dvec3 size = shape.half_size(), center(0, middle, 0);
  std::vector<Ray> rays;
  for (int i = 0; i < 10'000; ++i) {
    const dvec3 o = center + (i % 2 ? 1.2 : 3.0) * size * in_cube(random),
                to = center + size * in_cube(random);
    switch (i % 10) {
      case 0:
        rays.push_back(ray_of({to.x, o.y, to.z}, {0, i % 4 ? 1 : -1, 0}));
        break;
      case 1:
        rays.push_back(ray_of({o.x, to.y, o.z}, {to.x - o.x, 0, to.z - o.z}));
        break;
      case 2:
        rays.push_back(ray_of({o.x, to.y, o.z}, {to.x - o.x, 1e-5 * uniform(random), to.z - o.z}));
        break;
      case 3:
        rays.push_back(ray_of(o, {-o.x, to.y - o.y, -o.z}));
        break;
      case 4:
        rays.push_back(ray_of(o, {1e-6 * uniform(random), 1, 1e-6 * uniform(random)}));
        break;
      case 5:
      case 6:
      case 7: {
        const ProfileCubic& cubic = shape.profile[random() % shape.profile.size()];
        const double t = 0.5 + 0.5 * uniform(random), turn = 3 * uniform(random), mix = 3 * uniform(random);
        const glm::dvec2 p = cubic.at(t), slope = glm::normalize(cubic.slope(t) + 1e-12);
        const dvec3 out(std::cos(turn), 0, std::sin(turn)), up(0, 1, 0), around = glm::cross(up, out);
        const dvec3 along = std::cos(mix) * (slope.x * out + slope.y * up) + std::sin(mix) * around;
        const dvec3 at = center + p.x * out + p.y * up +
                         std::pow(10, -3 - 2 * std::abs(uniform(random))) * uniform(random) *
                             (slope.y * out - slope.x * up);
        rays.push_back(ray_of(at - 2.0 * along, along));
        break;
      }
      default:
        rays.push_back(ray_of(o, to - o));
    }
  }
  return rays;
}

SceneDescription scene_of(const Lathe& lathe, double& middle, LatheShape& shape) {
  const ExactLathe exact = exact_lathe(lathe);
  middle = exact.middle;
  shape = exact.shape;
  SceneDescription scene = scenes::line_of_sight({0, 1, 5}, {0, 1, 0});
  scenes::place(scene, exact.shape, scenes::add_white(scene), glm::translate(glm::dmat4(1), {0, middle, 0}));
  return scene;
}

}  // namespace

TEST_CASE("rays meet a lathe where its profile is, also along it and along its axis") {
  for (const Case& one : lathes()) {
    LatheShape shape;
    double middle = 0;
    const SceneDescription scene = scene_of(one.lathe, middle, shape);
    const std::vector<Ray> rays = rays_at(shape, middle);
    for_each_tracer(scene, [&](const CompiledScene& flat, RayTracer& tracer, bool coherent) {
      CAPTURE(one.name);
      const std::vector<Hit> hits = tracer.trace(rays, coherent);
      const Instance& instance = flat.instances[0];
      std::size_t met = 0, wrong = 0, off = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray& r = rays[i];
        if (!is_right(flat, r, hits[i])) {
          UNSCOPED_INFO("ray " << i << " at " << hits[i].t);
          ++wrong;
        }
        if (hits[i].instance == NO_INSTANCE) continue;
        ++met;
        // The hit itself lies on the surface.
        const dvec3 p = dvec3(r.ox, r.oy, r.oz) + double(hits[i].t) * dvec3(r.dx, r.dy, r.dz);
        Object object;
        object.shape = shape;
        const UnitShape unit = unit_shape("", object);
        const double away =
            unit.scale.x * std::abs(unit_distance(unit, (p - dvec3(0, middle, 0)) / unit.scale));
        off += i % 40 == 9 && away > 4e-6;
      }
      CHECK(instance.shape == SHAPE_LATHE);
      CHECK(met > 3000);
      CHECK(wrong == 0);
      CHECK(off == 0);
    });
  }
}

TEST_CASE("a line leaves a closed lathe as often as it enters") {
  for (const Case& one : lathes()) {
    LatheShape shape;
    double middle = 0;
    const SceneDescription scene = scene_of(one.lathe, middle, shape);
    if (!shape.closed) continue;
    const std::vector<Ray> first = rays_at(shape, middle);
    for_each_tracer(scene, [&](const CompiledScene&, RayTracer& tracer, bool coherent) {
      CAPTURE(one.name);
      std::vector<Ray> rays = first;
      for (Ray& ray : rays) {  // from far outside
        const float back = 8 / std::sqrt(ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz);
        ray.ox -= back * ray.dx, ray.oy -= back * ray.dy, ray.oz -= back * ray.dz;
      }
      std::vector<int> inside(rays.size()), most(rays.size());
      for (int round = 0; round < 24; ++round) {
        const std::vector<Hit> hits = tracer.trace(rays, coherent);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (hits[i].instance == NO_INSTANCE) continue;
          const vec3 ng(hits[i].ng_x, hits[i].ng_y, hits[i].ng_z);
          inside[i] += glm::dot(ng, {rays[i].dx, rays[i].dy, rays[i].dz}) < 0 ? 1 : -1;
          ++most[i];
          rays[i].t_min = hits[i].t;
        }
      }
      std::size_t odd = 0, unpaired = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) odd += most[i] % 2, unpaired += inside[i] != 0;
      CHECK(odd <= 3);  // where an entry and its exit round to one distance
      CHECK(unpaired <= 10);
    });
  }
}
