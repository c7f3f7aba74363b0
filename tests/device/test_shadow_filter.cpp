// What transmissive things leave of a light in their shadow: closed forms.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

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

}  // namespace

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
  for (const DeviceInfo& device : test_devices())
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
  for (const DeviceInfo& device : test_devices()) DYNAMIC_SECTION(device.label()) {
      CHECK(scenes::pixel_on(device, scene).x == 0);
    }
}
