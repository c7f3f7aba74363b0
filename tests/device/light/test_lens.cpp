// The camera's lens and motion by geometry.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "devices.h"
#include "moving_edge.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

using moving_edge::size;

/// A glowing ball of radius 0.02 at the depth 8, straight ahead.
SceneDescription ball_ahead() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 0}, {0, 0, -8});
  scene.camera.fov = 20;
  scene.image.width = scene.image.height = size;
  scene.render.samples = 128;
  scenes::place(scene, SphereShape{0.02}, scenes::add_glow(scene, {1, 1, 1}),
                glm::translate(glm::dmat4(1), {0, 0, -8}));
  return scene;
}

/// How far light reaches from the middle along a direction in the image, in pixels, and its sum.
struct Spread {
  double along = 0, sum = 0;
};
Spread spread_along(const Image& image, double x, double y) {
  Spread spread;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double value = double(image.pixel(column, row)[0]);
      spread.sum += value;
      if (value > 0)
        spread.along = std::max(spread.along, (column + 0.5 - size / 2) * x + (row + 0.5 - size / 2) * y);
    }
  return spread;
}

}  // namespace

TEST_CASE("the circle of confusion is as large as geometry has it, and what is at the focus is sharp") {
  SceneDescription scene = ball_ahead();
  const double scale = moving_edge::pixels_a_unit(scene), ball = 0.02 / 8 * scale;
  on_picture_devices([&](const DeviceInfo& device) {
    const Spread sharp = spread_along(scenes::render_on(device, scene).image, 1, 0);
    SceneDescription blurred = scene;
    blurred.camera.lens = {.radius = 0.3, .focus = 4};
    const Image image = scenes::render_on(device, blurred).image;
    const double expected = 0.3 * (1.0 / 4 - 1.0 / 8) * scale + ball;
    CHECK(std::abs(spread_along(image, 1, 0).along - expected) < 1);
    CHECK(std::abs(spread_along(image, 0.6, -0.8).along - expected) < 1);
    CHECK(spread_along(image, 1, 0).sum == Approx(sharp.sum).epsilon(0.1));
    SceneDescription focused = blurred;
    focused.camera.lens.focus = std::nullopt;  // the target
    CHECK(spread_along(scenes::render_on(device, focused).image, 1, 0).along == sharp.along);
    SceneDescription square = blurred;  // its corners lie to the right, up, left and down
    square.camera.lens.blades = 4;
    const Image diamond = scenes::render_on(device, square).image;
    CHECK(std::abs(spread_along(diamond, 1, 0).along - expected) < 2.2);  // few samples lie in a corner
    CHECK(std::abs(spread_along(diamond, std::sqrt(0.5), std::sqrt(0.5)).along -
                   ((expected - ball) * std::sqrt(0.5) + ball)) < 1);
    square.camera.lens.rotate = 45;
    CHECK(std::abs(spread_along(scenes::render_on(device, square).image, 1, 0).along -
                   ((expected - ball) * std::sqrt(0.5) + ball)) < 1);
  });
}

TEST_CASE("a moving camera makes of an edge a ramp as wide as it moves") {
  SceneDescription scene = moving_edge::scene();
  scene.camera.moves_to = View{{0.5, 0, 0}, {0.5, 0, -5}};
  on_picture_devices([&](const DeviceInfo& device) { moving_edge::check_ramp(device, scene, 0.5); });
}

TEST_CASE("an orthographic camera sees a ball as large at any depth, where its parallel ray meets it") {
  SceneDescription scene = scenes::line_of_sight({0, 0, 0}, {0, 0, -8});
  scene.camera.orthographic = 4;
  scene.image.width = scene.image.height = size;
  scene.render.samples = 16;
  const double pixel = 4.0 / size, radius = 0.5, area = M_PI * radius * radius / (pixel * pixel);
  const int glow = scenes::add_glow(scene, {1, 1, 1});
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double depth : {2.0, 50.0}) {
      SceneDescription placed = scene;
      scenes::place(placed, SphereShape{radius}, glow, glm::translate(glm::dmat4(1), {1, -0.5, -depth}));
      const Image image = scenes::render_on(device, placed).image;
      double sum = 0, across = 0, down = 0;
      for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
          const double value = double(image.pixel(column, row)[0]);
          sum += value, across += value * (column + 0.5), down += value * (row + 0.5);
        }
      CHECK(sum == Approx(area).epsilon(0.02));
      CHECK(across / sum == Approx(size / 2.0 + 1 / pixel).margin(0.1));
      CHECK(down / sum == Approx(size / 2.0 + 0.5 / pixel).margin(0.1));
      placed.camera.moves_to = View{{2, 0, 0}, {2, 0, -8}};  // on the mean 1 to the right
      double moved = 0, all = 0;
      const Image blurred = scenes::render_on(device, placed).image;
      for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
          all += double(blurred.pixel(column, row)[0]);
          moved += double(blurred.pixel(column, row)[0]) * (column + 0.5);
        }
      CHECK(moved / all == Approx(size / 2.0).margin(0.5));
      placed.camera.moves_to.reset();
      placed.camera.lens = {.radius = 0.2, .focus = depth};  // sharp there
      CHECK(spread_along(scenes::render_on(device, placed).image, 1, 0).along ==
            Approx((1 + radius) / pixel).margin(1.5));
    }
  });
}
