// Closed forms of refraction, reflection and absorption, through the whole path from description to pixel, on
// every device.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;

glm::dmat4 at(dvec3 position) { return glm::translate(glm::dmat4(1), position); }

double normal_reflectance(double n) { return std::pow((n - 1) / (n + 1), 2); }

double fresnel(double angle, double n) {
  const double ci = std::cos(angle), ct = std::sqrt(1 - std::pow(std::sin(angle) / n, 2));
  const double parallel = (n * ci - ct) / (n * ci + ct), perpendicular = (ci - n * ct) / (ci + n * ct);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

}  // namespace

TEST_CASE("Snell: a ray into a half-space of glass meets the small disk where the law says") {
  const double n = 1.5, incidence = pi / 4, depth = 2;
  const double meets = depth * std::tan(std::asin(std::sin(incidence) / n));
  SceneDescription scene = scenes::line_of_sight({-3, 3, 0}, {0, 0, 0});
  const int glass = scenes::add_dielectric(scene, n), glow = scenes::add_glow(scene, {1, 1, 1});
  scenes::place(scene, PlaneShape{}, glass);
  SECTION("at the predicted place") {
    scenes::place(scene, DiskShape{1e-4, 0}, glow, at({meets, -depth, 0}));
    on_picture_devices([&](const DeviceInfo& device) {
      REQUIRE(scenes::pixel_on(device, scene).x == Approx(1 - fresnel(incidence, n)).epsilon(1e-5));
    });
  }
  SECTION("and not beside it") {
    scenes::place(scene, DiskShape{1e-4, 0}, glow, at({meets + 3e-4, -depth, 0}));
    on_picture_devices([&](const DeviceInfo& device) { REQUIRE(scenes::pixel_on(device, scene).x == 0.0); });
  }
}

TEST_CASE("Fresnel at normal incidence reflects ((n - 1) / (n + 1))^2") {
  for (const double n : {1.1, 1.31, 1.5, 2.4}) {
    SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
    scenes::place(scene, PlaneShape{}, scenes::add_dielectric(scene, n));
    scenes::place(scene, PlaneShape{}, scenes::add_glow(scene, {1, 1, 1}), at({0, 10, 0}));
    on_picture_devices([&](const DeviceInfo& device) {
      REQUIRE(scenes::pixel_on(device, scene).x == Approx(normal_reflectance(n)).epsilon(1e-5));
    });
  }
}

TEST_CASE("beyond the critical angle everything is reflected, below it the Fresnel share") {
  const double n = 1.5, critical = std::asin(1 / n);
  for (const double angle : {critical + 0.01, critical + 0.3, critical - 0.2}) {
    // The camera is inside the glass under the plane y = 0 and looks up at it.
    SceneDescription scene = scenes::line_of_sight({-std::tan(angle), -1, 0}, {0, 0, 0});
    scenes::place(scene, PlaneShape{}, scenes::add_dielectric(scene, n));
    scenes::place(scene, PlaneShape{}, scenes::add_glow(scene, {1, 1, 1}), at({0, -4, 0}));
    const double expected = angle > critical ? 1.0 : fresnel(angle, 1 / n);
    on_picture_devices([&](const DeviceInfo& device) {
      REQUIRE(scenes::pixel_on(device, scene).x == Approx(expected).epsilon(1e-4));
    });
  }
}

TEST_CASE("Beer-Lambert: a slab of matched index absorbs exp(-a d)") {
  const dvec3 a{0.1, 0.7, 2.0};
  SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
  scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
  scenes::place(scene, BoxShape{{3, 3, 0.75}}, scenes::add_dielectric(scene, 1, a));
  on_picture_devices([&](const DeviceInfo& device) {
    const dvec3 seen = scenes::pixel_on(device, scene);
    for (int i = 0; i < 3; ++i) REQUIRE(seen[i] == Approx(std::exp(-a[i] * 1.5)).epsilon(1e-5));
  });
}

TEST_CASE("Beer-Lambert: a light and the camera inside the medium") {
  // A white floor, lit from 2 above it and seen from 5 above it, all in one ball of fog.
  const dvec3 a{0.05, 0.2, 0.4};
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scene.lights.clear();
  LightDescription point;
  point.position = {0, 2, 0};
  point.intensity = 0.8;
  scene.lights.push_back(point);
  scenes::place(scene, SphereShape{20}, scenes::add_dielectric(scene, 1.2, a));
  scenes::place(scene, DiskShape{1, 0}, scenes::add_white(scene));
  on_picture_devices([&](const DeviceInfo& device) {
    const dvec3 seen = scenes::pixel_on(device, scene);
    for (int i = 0; i < 3; ++i) REQUIRE(seen[i] == Approx(0.8 * std::exp(-a[i] * (2 + 5))).epsilon(1e-5));
  });
}

TEST_CASE("a light inside a medium shines out through the interface, filtered") {
  // The floor is outside the ball of fog that holds the light: 1 of fog, the Fresnel share at normal
  // incidence, then 3 of air.
  const double a = 0.3, n = 1.4;
  SceneDescription scene = scenes::line_of_sight({0.5, 3, 0}, {0, 0, 0});
  scene.lights.clear();
  LightDescription point;
  point.position = {0, 4, 0};
  scene.lights.push_back(point);
  scenes::place(scene, SphereShape{1}, scenes::add_dielectric(scene, n, dvec3(a)), at({0, 4, 0}));
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  on_picture_devices([&](const DeviceInfo& device) {
    REQUIRE(scenes::pixel_on(device, scene).x ==
            Approx(std::exp(-a) * (1 - normal_reflectance(n))).epsilon(1e-4));
  });
}

TEST_CASE("mirror in mirror: the glow is met once for each level, to the exact depth") {
  for (const int depth : {1, 2, 7, 30}) {
    SceneDescription scene = scenes::line_of_sight({0, 1, 0}, {0, 0, 0}, {0, 0, 1});
    scene.render.max_depth = depth;
    const int mirror = scenes::add_mirror(scene, 1, {1, 0.5, 0.25});
    scenes::place(scene, PlaneShape{}, mirror);
    scenes::place(scene, PlaneShape{}, mirror, at({0, 2, 0}));
    on_picture_devices([&](const DeviceInfo& device) {
      const RenderResult result = scenes::render_on(device, scene);
      REQUIRE(result.image.data[0] == static_cast<float>(depth));
      REQUIRE(result.counts[COUNT_REFLECTION] == static_cast<std::uint64_t>(depth - 1));
      REQUIRE(result.counts[COUNT_DEPTH_LIMIT] == 1);
      REQUIRE(result.counts[COUNT_RAY_STACK_OVERFLOW] == 0);
    });
  }
}

TEST_CASE("a mirror returns its share of the energy at each bounce") {
  SceneDescription scene = scenes::line_of_sight({0, 3, 3}, {0, 0, 0});
  scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
  scenes::place(scene, PlaneShape{}, scenes::add_mirror(scene, 0.6));
  on_picture_devices([&](const DeviceInfo& device) {
    REQUIRE(scenes::pixel_on(device, scene).x == Approx(0.6).epsilon(1e-6));
  });
}

TEST_CASE("in a furnace of white light clear glass is as white, whatever the index") {
  for (const double n : {0.7, 1.31, 2.0}) {
    SceneDescription scene = scenes::line_of_sight({0.3, 0.2, 5}, {0.3, 0.2, 0});
    scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
    scene.render.max_depth = 30;
    scenes::place(scene, SphereShape{1}, scenes::add_dielectric(scene, n));
    on_picture_devices([&](const DeviceInfo& device) {
      REQUIRE(scenes::pixel_on(device, scene).x == Approx(1.0).epsilon(2e-5));
    });
  }
}
