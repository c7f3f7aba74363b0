// Renders an edge that moves while the shutter is open, and measures its ramp.
#include "moving_edge.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "scenes.h"

using namespace sundog;

namespace moving_edge {

double pixels_a_unit(const SceneDescription& scene) {
  return size / (2 * std::tan(glm::radians(scene.camera.fov) / 2));
}

SceneDescription scene() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 0}, {0, 0, -5});
  scene.camera.fov = 20;
  scene.image.width = scene.image.height = size;
  scene.render.samples = 16;
  scenes::place(scene, BoxShape{{50, 50, 1}}, scenes::add_glow(scene, {1, 1, 1}),
                glm::translate(glm::dmat4(1), {50, 0, -6}));
  return scene;
}

void check_ramp(const DeviceInfo& device, const SceneDescription& scene, double way) {
  const double ramp = way / 5 * pixels_a_unit(scene);
  const Image image = scenes::render_on(device, scene).image;
  for (int column = 0; column < size; ++column) {
    double mean = 0;
    for (int row = 0; row < size; ++row) mean += double(image.pixel(column, row)[0]) / size;
    const double expected = std::clamp((column + 0.5 - (size / 2.0 - ramp)) / ramp, 0.0, 1.0);
    INFO(column);
    CHECK(std::abs(mean - expected) < 0.03);
  }
}

}  // namespace moving_edge
