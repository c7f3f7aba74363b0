// Things that move while the shutter is open: a moving edge by closed form; the blurred picture is the mean
// of still ones, also in mirrors, through glass and in shadows.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "moving_edge.h"
#include "same_bits.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

SceneDescription moving_things() { return load_scene(SUNDOG_SOURCE_DIR "/tests/support/moving_things.json"); }

/// The scene as it is at a time, with its own kernels: something behind the camera still moves.
SceneDescription still_at(SceneDescription scene, double time, int samples) {
  for (Object& object : scene.objects) {
    object.world_from_object[3] += glm::dvec4(time * object.moves_by, 0);
    object.moves_by = dvec3(0);
  }
  scenes::place(scene, SphereShape{0.01}, 0, glm::translate(glm::dmat4(1), dvec3(0, 9, 30)));
  scene.objects.back().moves_by = {0, 1, 0};
  scene.render.samples = samples;
  return scene;
}

/// The greatest difference of the means of blocks of 4x4 pixels, and the mean of these differences.
struct BlockDifference {
  double most = 0, mean = 0;
};
BlockDifference difference(const Image& a, const Image& b) {
  BlockDifference result;
  for (int y = 0; y < a.height; y += 4)
    for (int x = 0; x < a.width; x += 4)
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int i = 0; i < 16; ++i) {
          const int column = x + i % 4, row = y + i / 4;
          sum += double(a.pixel(column, row)[c]) - double(b.pixel(column, row)[c]);
        }
        result.most = std::max(result.most, std::abs(sum) / 16);
        result.mean += std::abs(sum) / 16 / (a.width / 4.0 * a.height / 4.0 * 3);
      }
  return result;
}

/// The mean of still pictures, evenly in time.
Image mean_of_stills(const DeviceInfo& device, const SceneDescription& scene, int times, int samples) {
  Image mean;
  for (int k = 0; k < times; ++k) {
    const Image one = scenes::render_on(device, still_at(scene, (k + 0.5) / times, samples)).image;
    if (k == 0) mean = Image(one.width, one.height, one.channels);
    for (std::size_t i = 0; i < one.data.size(); ++i) mean.data[i] += one.data[i] / static_cast<float>(times);
  }
  return mean;
}

}  // namespace

TEST_CASE("an edge that moves becomes a ramp as wide as it moves") {
  SceneDescription scene = moving_edge::scene();
  scene.objects.back().moves_by = {-0.5, 0, 0};
  on_picture_devices([&](const DeviceInfo& device) { moving_edge::check_ramp(device, scene, 0.5); });
}

TEST_CASE("a picture of moving things is the mean of still ones, and the same for every tile and group") {
  SceneDescription scene = moving_things();
  on_picture_devices([&](const DeviceInfo& device) {
    const Image stills = mean_of_stills(device, scene, 16, 16);
    const Image blurred = scenes::render_on(device, scene).image;
    const BlockDifference apart = difference(blurred, stills);
    CHECK(apart.most < 0.03);
    CHECK(apart.mean < 0.003);
    CHECK(difference(blurred, scenes::render_on(device, still_at(scene, 0, 16)).image).mean > 0.015);
    RenderOptions options;
    options.tile = 8;
    options.work_group = {WorkGroup::Kind::fixed, 2, 1};
    CHECK(same_bits(blurred, scenes::render_on(device, scene, options).image));
    scene.render.tracer = Tracer::compact;
    const BlockDifference compact = difference(blurred, scenes::render_on(device, scene).image);
    CHECK(compact.most < 0.005);
  });
}

TEST_CASE("paths carry one time each") {
  SceneDescription scene = moving_things();
  scene.render.integrator = "path";
  scene.render.max_depth = 3;
  scene.render.samples = 256;
  on_picture_devices([&](const DeviceInfo& device) {
    const BlockDifference apart =
        difference(scenes::render_on(device, scene).image, mean_of_stills(device, scene, 16, 32));
    CHECK(apart.most < 0.06);
    CHECK(apart.mean < 0.008);
  });
}

TEST_CASE("groups add their moves to those of their objects, and bounds hold the whole way") {
  const SceneDescription scene = moving_things();
  const dvec3 ball = scene.objects.at(1).moves_by, mesh = scene.objects.at(2).moves_by;
  CHECK(glm::length(ball - dvec3(0.5, 0, 0)) < 1e-12);
  CHECK(glm::length(mesh - dvec3(0.5, 0.4, -0.3)) < 1e-12);
  const CompiledScene compiled = compile(scene);
  CHECK(compiled.features.object_motion);
  REQUIRE(compiled.moves.size() == compiled.instances.size());
  for (std::size_t i = 0; i < compiled.instances.size(); ++i) {
    const Instance& instance = compiled.instances[i];
    if (instance.shape != SHAPE_SPHERE || scene.objects[instance.object].moves_by == dvec3(0)) continue;
    CHECK(double(instance.world_center.w) > std::sqrt(0.85 * 0.85 + 2 * 0.36) - 1e-3);
    CHECK(std::abs(double(instance.world_center.x) + compiled.origin.x -
                   (scene.objects[instance.object].world_from_object[3].x + 0.25)) < 1e-3);
  }
  SceneDescription without = scene;
  for (Object& object : without.objects) object.moves_by = dvec3(0);
  CHECK_FALSE(compile(without).features.object_motion);
  CHECK(compile(without).moves.empty());
  SceneDescription too_far = scene;
  too_far.objects[1].moves_by = {1e300, 0, 0};
  CHECK_THROWS_AS(compile(too_far), SceneError);
}
