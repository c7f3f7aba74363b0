// Marching: hits of closed forms, cuts, both sides of a surface, limits.
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "formula/lower.h"
#include "sdf_marching.h"

using namespace sundog;
using glm::dvec3;

namespace {

std::vector<Ray> random_rays(int count, double distance, double target) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const dvec3 o = distance * glm::normalize(dvec3(normal(random), normal(random), normal(random)));
    const dvec3 to = target * dvec3(normal(random), normal(random), normal(random));
    rays.push_back(make_ray(o, (to - o) * (0.25 + 0.05 * (i % 40))));  // of many lengths
  }
  return rays;
}

/// First crossing of the unit sphere, infinite where there is none.
double sphere_hit(const Ray& ray, double radius = 1) {
  const Plain r(ray);
  const double a = glm::dot(r.d, r.d), b = glm::dot(r.o, r.d), c = glm::dot(r.o, r.o) - radius * radius;
  const double square = b * b - a * c;
  return square < 0 ? INFINITY : (-b - std::sqrt(square)) / a;
}
double box_hit(const Ray& ray, const dvec3& half) {
  const Plain r(ray);
  double first = -INFINITY, last = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const double a = (-half[i] - r.o[i]) / r.d[i], b = (half[i] - r.o[i]) / r.d[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first > last ? INFINITY : first;
}

/// The unit ball as a Julia set: power 2, c = 0.
SdfDescription julia_ball() {
  auto julia = listed_field("julia");
  julia.root.formula.steps[0].values = {2, 0, 0, 0, 0, 0};
  return julia;
}

}  // namespace

TEST_CASE("a marched sphere and box are the exact ones") {
  auto ball = listed_field("sphere"), box = listed_field("box");
  ball.lower = box.lower = dvec3(-1.5);
  ball.upper = box.upper = dvec3(1.5);
  box.root.formula.steps[0].values = {0.9, 0.6, 0.8};
  const SdfDescription both[] = {ball, box};
  const CompiledFields fields = compile_fields(both);
  const auto rays = random_rays(4096, 4, 0.6);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    for (u32 field = 0; field < 2; ++field) {
      const auto hits = march(device, fields, rays, {.field = field});
      int wrong = 0, grazing = 0;
      double worst = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const double wanted = field == 0 ? sphere_hit(rays[i]) : box_hit(rays[i], {0.9, 0.6, 0.8});
        const bool hit = hits[i].prim & 1u;
        const double length = glm::length(Plain(rays[i]).d);
        if (hit != std::isfinite(wanted))
          ++grazing;  // within the threshold of the outline
        else if (hit)
          worst = std::max(worst, std::abs(hits[i].t - wanted) * length);
        wrong += hits[i].prim & 6u;
      }
      INFO((field == 0 ? "sphere" : "box"));
      CHECK(wrong == 0);
      CHECK(grazing <= 4);
      CHECK(worst < 3e-5);  // in units of the field, from 4 away
    }
  });
}

TEST_CASE("marching gives the same bits for every number of lanes") {
  const CompiledFields fields = compiled(listed_field("mandelbulb"));
  const auto rays = random_rays(1024, 3, 0.4);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto wanted = march(device, fields, rays, {.lanes = 1, .spread = 1e-3f});
    int hit = 0;
    for (const Hit& h : wanted) hit += h.prim & 1u;
    CHECK(hit > 500);
    for (const int lanes : {4, 8, 16}) {
      if (!is_quick(info) && lanes != 4) continue;
      const auto found = march(device, fields, rays, {.lanes = lanes, .spread = 1e-3f});
      int different = 0;
      for (std::size_t i = 0; i < rays.size(); ++i)
        different += found[i].t != wanted[i].t || found[i].prim != wanted[i].prim ||
                     found[i].u != wanted[i].u || found[i].ng_x != wanted[i].ng_x;
      CHECK(different == 0);
    }
  });
}

TEST_CASE("the interval cuts the surface and the cut is solid") {
  auto ball = listed_field("sphere");
  ball.lower = {-1.5, -1.5, -1.5};
  ball.upper = {1.5, 0.25, 1.5};  // a sphere with its top cut off at y = 0.25
  const CompiledFields fields = compiled(ball);
  std::vector<Ray> down;
  for (int i = 0; i < 256; ++i)
    down.push_back(make_ray({-1.2 + 2.4 * (i % 16) / 15, 3, -1.2 + 2.4 * (i / 16) / 15}, {0, -1, 0}));
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields, down);
    for (std::size_t i = 0; i < down.size(); ++i) {
      const double r = std::hypot(down[i].ox, down[i].oz), rim = std::sqrt(1 - 0.25 * 0.25);
      if (std::abs(r - rim) < 1e-3 || std::abs(r - 1) < 1e-3) continue;
      INFO("radius " << r);
      CHECK((hits[i].prim & 3u) == (r < rim ? 3u : r < 1 ? 1u : 0u));
      if (r < rim) {
        CHECK(hits[i].t == Approx(2.75));
        CHECK(hits[i].ng_y == 1.0f);
      } else if (r < 1) {
        CHECK(hits[i].t == Approx(3 - std::sqrt(1 - r * r))
                               .margin(1e-4));  // below the cut, from above: the sphere widens there
      }
    }
    // from inside, upwards: out through the cut
    std::vector<Ray> up;
    for (int i = 0; i < 16; ++i) up.push_back(make_ray({0.05 * i, -0.3, 0}, {0, 1, 0}));
    for (const Hit& hit : march(device, fields, up, {.mode = 1})) {
      CHECK((hit.prim & 7u) == 3u);
      CHECK(hit.t == Approx(0.55));
      CHECK(hit.ng_y == 1.0f);
    }
  });
}

TEST_CASE("a ball cuts a field as the interval does") {
  auto box = listed_field("box");
  box.sphere = glm::dvec4(0, 0, 0, 1.2);
  box.lower = dvec3(-2);
  box.upper = dvec3(2);
  const CompiledFields fields = compiled(box);
  const Ray corner = make_ray({3, 3, 3}, {-1, -1, -1}), face = make_ray({3, 0.1, 0.1}, {-1, 0, 0});
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields, {corner, face});
    CHECK(hits[0].prim == 3u);  // the box's corner lies beyond the ball
    CHECK(hits[0].t == Approx(3 - 1.2 / std::sqrt(3.0)));
    CHECK(hits[0].ng_x == Approx(1 / std::sqrt(3.0)));
    CHECK(hits[1].prim == 1u);
    CHECK(hits[1].t == Approx(2).margin(1e-5));
    CHECK(hits[1].ng_x == 1.0f);
  });
}

TEST_CASE("a ray that starts on the surface leaves it, whichever side it takes") {
  const CompiledFields fields = compiled(listed_field("sphere"));
  std::vector<Ray> outwards, inwards;
  for (int i = 0; i < 64; ++i) {
    const double a = 0.1 * i, up = 0.02 + 0.015 * i;  // from grazing to steep
    const dvec3 n(std::cos(a), 0, std::sin(a)), side(-n.z, 0, n.x);
    for (const double height : {3e-5, 5e-4})  // below the threshold, and above it
      outwards.push_back(make_ray(n * (1 + height), glm::normalize(side + up * n)));
    inwards.push_back(make_ray(n * 0.9995, glm::normalize(side - up * n)));
  }
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    for (const Hit& hit : march(device, fields, outwards, {.mode = 2, .footprint = 1e-4f}))
      CHECK_FALSE(hit.prim & 1u);
    const auto hits = march(device, fields, inwards, {.mode = 3, .footprint = 1e-4f});
    for (std::size_t i = 0; i < inwards.size(); ++i) {
      const Plain r(inwards[i]);
      const double b = glm::dot(r.o, r.d), chord = -b + std::sqrt(b * b - glm::dot(r.o, r.o) + 1);
      CHECK(hits[i].prim == 1u);
      CHECK(hits[i].t == Approx(chord).margin(1e-4));
      CHECK(hits[i].ng_x * r.d.x + hits[i].ng_z * r.d.z > 0);  // outward, along the ray
    }
  });
}

TEST_CASE("t_max ends a march and the step limit is counted as a hit") {
  auto ball = listed_field("sphere");
  const CompiledFields fields = compiled(ball);
  ball.step_limit = 2;
  ball.root.formula.safety = 0.1;
  const CompiledFields hurried = compiled(ball);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields,
                            {make_ray({0, 0, 3}, {0, 0, -1}, 0, 1.9), make_ray({0, 0, 3}, {0, 0, -1}, 0, 2.1),
                             make_ray({0, 0, 3}, {0, 0, -1}, 4.5, 9), make_ray({3, 3, 3}, {1, 0, 0}),
                             make_ray({0, 0, 3}, {0, 0, -1e-3})});
    CHECK(hits[0].prim == 0u);
    CHECK(hits[1].prim == 1u);
    CHECK(hits[2].prim == 0u);  // starts behind the interval
    CHECK(hits[3].prim == 0u);
    CHECK(hits[4].prim == 1u);
    CHECK(hits[4].t == Approx(2000).epsilon(1e-4));
    const auto limited = march(device, hurried, {make_ray({0, 0, 3}, {0, 0, -1})});
    CHECK(limited[0].prim == 5u);
    CHECK(limited[0].u == 2.0f);
  });
}

TEST_CASE("the normal of an estimated surface is the body's own") {
  const CompiledFields fields = compiled(julia_ball());
  std::vector<Ray> rays;
  for (int i = 0; i < 32; ++i) {
    const dvec3 n = glm::normalize(dvec3(std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i + 1)));
    rays.push_back(make_ray(3.0 * n, -n));
  }
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields, rays, {.footprint = 2e-4f});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const dvec3 n(hits[i].ng_x, hits[i].ng_y, hits[i].ng_z);
      CHECK(hits[i].prim == 1u);
      CHECK(glm::dot(n, -Plain(rays[i]).d) > 0.99);
    }
  });
}

TEST_CASE("a fractal is entered and left: the way through a Julia set's body is found from inside") {
  const CompiledFields fields = compiled(julia_ball());
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i)
    rays.push_back(make_ray({0.6 * std::sin(i), 0.5 * std::cos(2.0 * i), 0.1},
                            glm::normalize(dvec3(std::cos(3.0 * i), std::sin(3.0 * i), 0.3))));
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields, rays, {.mode = 1, .footprint = 2e-4f});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Plain r(rays[i]);
      const double b = glm::dot(r.o, r.d), chord = -b + std::sqrt(b * b - glm::dot(r.o, r.o) + 1);
      CHECK(hits[i].prim == 1u);
      CHECK(hits[i].t == Approx(chord).margin(6e-4));
    }
  });
}
