// Two colours in a checkerboard as a material's colour: far away their mean, as a texture's are.
#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A floor of cells of 1, white and black, along a line of sight that a pixel of `fov` degrees sees.
SceneDescription floor_seen(double fov, const dvec3& target, const char* integrator) {
  SceneDescription scene = scenes::line_of_sight({target.x, 40, 90}, target);
  scene.camera.fov = fov;
  scene.render.integrator = integrator;
  const int floor = scenes::add_white(scene);
  MaterialDescription& material = scene.materials.back();
  material.checker = true;
  material.checker_size = 1;
  material.checker_diffuse = dvec3(0);
  scenes::place(scene, PlaneShape{}, floor);
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {0, -1, 0};
  scene.lights.assign(1, sun);
  return scene;
}

double brightness(const DeviceInfo& device, const SceneDescription& scene) {
  return double(scenes::render_on(device, scene).image.data[0]);
}

}  // namespace

TEST_CASE("a checker in a material's color has its colors near by and their mean far away") {
  for (const char* integrator : {"whitted", "path"})
    on_picture_devices([&](const DeviceInfo& device) {
      INFO(integrator);
      for (const double x : {0.5, 1.5, 2.5, 3.5}) {
        const double light = brightness(device, floor_seen(1e-3, {x, 0, 0.5}, integrator));
        CHECK(light == Approx(int(x) % 2 == 0 ? 1 : 0));
        CHECK(brightness(device, floor_seen(20, {x, 0, 0.5}, integrator)) == Approx(0.5).margin(0.02));
      }
      // A pixel about as wide as half a cell, across the border of two: their colors in part.
      const double between = brightness(device, floor_seen(0.3, {2, 0, 0.5}, integrator));
      CHECK(between == Approx(0.5).margin(0.05));
    });
}
