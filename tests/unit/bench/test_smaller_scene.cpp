// Frames made smaller until they can be measured in time.
#include "bench/frames/smaller_scene.h"
#include "catch.h"

using namespace sundog;

namespace {

CompiledScene frame(u32 width, u32 height, u32 samples) {
  CompiledScene scene;
  scene.info.width = width;
  scene.info.height = height;
  scene.info.samples = samples;
  scene.info.camera_dx = {0.01f, 0.002f, 0, 0};
  scene.info.camera_dy = {0, -0.01f, 0.003f, 0};
  return scene;
}

/// The time of a frame whose pixels cost the same everywhere.
auto costing(double per_sample) {
  return [=](const CompiledScene& scene) {
    return per_sample * scene.info.width * scene.info.height * scene.info.samples;
  };
}

}  // namespace

TEST_CASE("a smaller frame shows the whole view") {
  const CompiledScene whole = frame(800, 600, 16), small = smaller_scene(whole, 2000, 3.7);
  CHECK(small.info.width * small.info.height == Approx(2000).epsilon(0.05));
  CHECK(small.info.samples == 3);
  CHECK(static_cast<float>(small.info.width) * small.info.camera_dx.x == Approx(8));
  CHECK(static_cast<float>(small.info.width) * small.info.camera_dx.y == Approx(1.6));
  CHECK(static_cast<float>(small.info.height) * small.info.camera_dy.y == Approx(-6));
  CHECK(static_cast<float>(small.info.height) * small.info.camera_dy.z == Approx(1.8));
}

TEST_CASE("a frame is never made larger, nor smaller than a pixel") {
  const CompiledScene whole = frame(40, 30, 4), same = smaller_scene(whole, 1e9, 1e12);
  CHECK(same.info.width == 40);
  CHECK(same.info.height == 30);
  CHECK(same.info.samples == 4);
  CHECK(same.info.camera_dx.x == whole.info.camera_dx.x);
  const CompiledScene least = smaller_scene(whole, 0, 0);
  CHECK(least.info.width == 1);
  CHECK(least.info.height == 1);
  CHECK(least.info.samples == 1);
}

TEST_CASE("a frame is cut down to its time, samples first, and kept where it fits") {
  const CompiledScene whole = frame(800, 600, 16);
  const CompiledScene kept = scene_in_time(whole, 1, costing(1e-7));
  CHECK((kept.info.width == 800 && kept.info.samples == 16));
  const CompiledScene fewer = scene_in_time(whole, 1, costing(5e-7));
  CHECK((fewer.info.width == 800 && fewer.info.samples == 4));
  const CompiledScene smaller = scene_in_time(whole, 1, costing(1e-4));
  CHECK(smaller.info.samples == 1);
  CHECK(costing(1e-4)(smaller) == Approx(1).epsilon(0.05));
}

TEST_CASE("a frame is measured at a size where it takes long enough, and tiny ones first") {
  std::size_t measured = 0;
  double most = 0;
  scene_in_time(frame(8000, 6000, 16), 1, [&](const CompiledScene& scene) {
    ++measured;
    return most = costing(1e-4)(scene);
  });
  CHECK(measured == 1);
  CHECK(most < 0.1);
  measured = 0;
  scene_in_time(frame(800, 600, 16), 1, [&](const CompiledScene& scene) {
    ++measured;
    return costing(1e-7)(scene);
  });
  CHECK(measured == 3);  // 512, 8192 and 131072 pixels
}
