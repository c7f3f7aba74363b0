// The light in the shadow of transmissive solids, in closed form.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/plain/whitted.h"
#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;

namespace {

// Fresnel's reflectance from the rarer side.
double reflectance(double degrees, double index) {
  const double cos_i = std::cos(glm::radians(degrees)), sin_t = std::sin(glm::radians(degrees)) / index;
  const double cos_t = std::sqrt(1 - sin_t * sin_t);
  const double s = (cos_i - index * cos_t) / (cos_i + index * cos_t),
               p = (index * cos_i - cos_t) / (index * cos_i + cos_t);
  return (s * s + p * p) / 2;
}

// A white floor at y = 0, seen from a distance of 1.5 at its point (0, 0, 0), under a point light 1.25 away.
SceneDescription lit_floor() {
  SceneDescription scene = scenes::line_of_sight({0, 0.9, 1.2}, {0, 0, 0});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  LightDescription point;
  point.position = {0.75, 1, 0};
  scene.lights.push_back(point);
  return scene;
}

const glm::dvec3 absorption(0.3, 0, 1.5);

// The lit floor through `absorption` from the light to the camera.
void check_dimmed(const glm::dvec3& seen) {
  for (int c = 0; c < 3; ++c)
    CHECK(seen[c] == Approx(0.8 * std::exp(-absorption[c] * (1.5 + 1.25))).epsilon(1e-5));
}

glm::dvec3 plain_pixel(const SceneDescription& scene) {
  const Image image = render_plain(compile(scene));
  return {image.data.at(0), image.data.at(1), image.data.at(2)};
}

}  // namespace

TEST_CASE("an absorbing world dims what lies between a light and an opaque scene") {
  SceneDescription scene = lit_floor();
  scene.media[0].absorption = absorption;
  SceneDescription shaded = scene;
  scenes::place(shaded, SphereShape{0.1}, scenes::add_white(shaded),
                glm::translate(glm::dmat4(1), {0.375, 0.5, 0}));
  check_dimmed(plain_pixel(scene));
  on_picture_devices([&](const DeviceInfo& device) {
    check_dimmed(scenes::pixel_on(device, scene));
    CHECK(scenes::pixel_on(device, shaded) == glm::dvec3(0));
  });
}

TEST_CASE("a medium whose surface stops shadow rays dims the lights inside of it") {
  SceneDescription scene = lit_floor();
  const int glass = scenes::add_dielectric(scene, 1.5, absorption);
  scene.materials[static_cast<std::size_t>(glass)].shadow_opaque = true;
  scenes::place(scene, BoxShape{{4, 4, 4}}, glass);
  check_dimmed(plain_pixel(scene));
  on_picture_devices([&](const DeviceInfo& device) { check_dimmed(scenes::pixel_on(device, scene)); });
}

TEST_CASE("a pane of glass at any slant dims a light by what its two faces reflect") {
  const double degrees = GENERATE(0.0, 30.0, 60.0, 80.0);
  SceneDescription scene = scenes::line_of_sight({0, 0.9, 3}, {0, 0, 0});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  scenes::place(scene, BoxShape{{1000, 0.1, 1000}}, scenes::add_dielectric(scene, 1.5),
                glm::translate(glm::dmat4(1), {0, 2, 0}));
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {std::sin(glm::radians(degrees)), -std::cos(glm::radians(degrees)), 0};
  scene.lights.push_back(sun);
  const double passed = 1 - reflectance(degrees, 1.5);
  for (const DeviceInfo& device : picture_devices())
    DYNAMIC_SECTION(device.label() << ", " << degrees << " degrees") {
      CHECK(scenes::pixel_on(device, scene).x ==
            Approx(std::cos(glm::radians(degrees)) * passed * passed).epsilon(1e-4));
    }
}

TEST_CASE("a directional light along an axis is stopped by what stands in its way") {
  SceneDescription scene = scenes::line_of_sight({0, 0.9, 3}, {0, 0, 0});
  const int white = scenes::add_white(scene);
  scenes::place(scene, PlaneShape{}, white);
  scenes::place(scene, BoxShape{{1, 0.1, 1}}, white, glm::translate(glm::dmat4(1), {0, 2, 0}));
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {0, -1, 0};  // towards it: (-0, 1, -0)
  scene.lights.push_back(sun);
  on_picture_devices([&](const DeviceInfo& device) { CHECK(scenes::pixel_on(device, scene).x == 0); });
}

TEST_CASE("a shadow ray that passes too many panes is given up, and counted") {
  const auto under = [](int panes) {
    SceneDescription scene = scenes::line_of_sight({3, 0.05, 0}, {0, 0, 0});
    LightDescription sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    scene.lights.push_back(sun);
    scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
    const int clear = scenes::add_mirror(scene, 0);
    scene.materials.back().transmission = {1, 1, 1};
    for (int i = 0; i < panes; ++i)
      scenes::place(scene, DiskShape{1, 0}, clear, glm::translate(glm::dmat4(1), {0, 1 + 0.1 * i, 0}));
    return scene;
  };
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult few = scenes::render_on(device, under(60)),
                       many = scenes::render_on(device, under(80));
    CHECK(few.image.data.at(0) == Approx(1).epsilon(1e-5));
    CHECK(few.counts[COUNT_SHADOW_LIMIT] == 0);
    CHECK(many.image.data.at(0) == 0);
    CHECK(many.counts[COUNT_SHADOW_LIMIT] == 1);
  });
}

TEST_CASE(
    "paths see a light straight through glass whose shadow is a filter, and not at all through other glass") {
  for (const double degrees : {0.0, 60.0}) {
    SceneDescription scene = scenes::line_of_sight({0, 0.9, 3}, {0, 0, 0});
    scene.render.integrator = "path";
    scene.render.max_depth = 1;  // the light itself, without what floor and pane throw at each other
    scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
    const int pane = scenes::add_dielectric(scene, 1.5, {0.2, 0, 0.4});
    scenes::place(scene, BoxShape{{1000, 0.1, 1000}}, pane, glm::translate(glm::dmat4(1), {0, 2, 0}));
    const double slant = std::cos(glm::radians(degrees));
    LightDescription sun;
    sun.type = LightType::directional;
    sun.direction = {std::sin(glm::radians(degrees)), -slant, 0};
    scene.lights = {sun};
    const DeviceInfo device = test_devices().front();
    INFO(degrees << " degrees");
    CHECK(scenes::pixel_on(device, scene) == glm::dvec3(0));
    scene.materials[static_cast<std::size_t>(pane)].shadow_filter = true;
    const glm::dvec3 seen = scenes::pixel_on(device, scene);
    const double passed = 1 - reflectance(degrees, 1.5), way = 0.2 / slant;
    CHECK(seen.x == Approx(slant * passed * passed * std::exp(-0.2 * way)).epsilon(1e-4));
    CHECK(seen.y == Approx(slant * passed * passed).epsilon(1e-4));
    CHECK(seen.z == Approx(slant * passed * passed * std::exp(-0.4 * way)).epsilon(1e-4));
  }
}
