// Many lights: a surface that chooses among them receives what it would of all.
#include <cmath>
#include <vector>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A white floor under `count` balls of light here and there, of many sizes and powers.
SceneDescription floor_under(int count) {
  SceneDescription scene = scenes::line_of_sight({1, 1, 0}, {0, 0, 0});
  scene.image.width = scene.image.height = 12;
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  u32 state = 1;
  const auto next = [&] { return double(state = state * 1664525u + 1013904223u) / 4294967296.0; };
  for (int i = 0; i < count; ++i) {
    LightDescription light;
    light.type = i % 3 == 0 ? LightType::rectangle : i % 3 == 1 ? LightType::disk : LightType::sphere;
    light.position = {20 * next() - 10, 0.8 + 3 * next(), 20 * next() - 10};
    light.direction = {0, -1, 0};
    light.radius = 0.05 + 0.2 * next();
    light.size = {0.1 + 0.3 * next(), 0.2};
    light.intensity = 5 * next();
    light.visible = false;
    scene.lights.push_back(light);
  }
  return scene;
}

struct Mean {
  double value, error, deviation;
};
Mean mean_of(const Image& image) {
  double sum = 0, squares = 0;
  const double count = double(image.data.size()) / 4;
  for (std::size_t i = 0; i < image.data.size(); i += 4) {
    sum += double(image.data[i]);
    squares += double(image.data[i]) * double(image.data[i]);
  }
  const double variance = std::max(squares / count - sum / count * sum / count, 0.0);
  return {sum / count, std::sqrt(variance / count), std::sqrt(variance)};
}

}  // namespace

TEST_CASE("chosen lights bring as much light as all of them do") {
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = floor_under(40);
    const RenderResult all = scenes::render_on(device, scene);
    for (const int samples : {1, 8}) {
      scene.render.light_samples = samples;
      const RenderResult chosen = scenes::render_on(device, scene);
      const Mean mean = mean_of(chosen.image), whole = mean_of(all.image);
      INFO(samples << ": " << mean.value << " +- " << mean.error << " for " << whole.value);
      CHECK(std::abs(mean.value - whole.value) < 3 * (mean.error + whole.error));
      // Near lights are chosen more often: by chance alone it would be 3 times the mean.
      CHECK(mean.deviation < 1.5 / std::sqrt(samples) * whole.value);
      CHECK(chosen.counts[COUNT_SHADOW] <= 144u * static_cast<unsigned>(samples));
    }
  });
}

TEST_CASE("a thousand lights need no more rays than are asked for") {
  SceneDescription scene = floor_under(1000);
  scene.render.light_samples = 4;
  LightDescription point;
  point.position = {0, 2, 0};
  scene.lights.push_back(point);  // sends one of its own
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult result = scenes::render_on(device, scene);
    CHECK(result.counts[COUNT_SHADOW] <= 144u * 5u);
    CHECK(mean_of(result.image).value > 1);
  });
}
