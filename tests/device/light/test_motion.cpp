// Things that move, turn and grow while the shutter is open: edges by closed form; the blurred picture is the
// mean of still ones, also in mirrors, through glass and in shadows.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/placing/motion.h"
#include "devices.h"
#include "moving_edge.h"
#include "same_bits.h"
#include "scene/load.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace sundog;
using glm::dvec3;

namespace {

SceneDescription moving_things() { return load_scene(SUNDOG_SOURCE_DIR "/tests/support/moving_things.json"); }

SceneDescription turning_things() {
  return load_scene(SUNDOG_SOURCE_DIR "/tests/support/turning_things.json");
}

/// The scene as it is at a time, with its own kernels: something behind the camera still moves, or turns.
SceneDescription still_at(SceneDescription scene, double time, int samples) {
  bool turns = false;
  for (Object& object : scene.objects) {
    turns |= !object.turns.empty();
    object.world_from_object = world_at(object, time) * object.world_from_object;
    object.moves_by = dvec3(0);
    object.turns.clear();
  }
  scenes::place(scene, SphereShape{0.01}, 0, glm::translate(glm::dmat4(1), dvec3(0, 9, 30)));
  scene.objects.back().moves_by = {0, 1, 0};
  if (turns) scene.objects.back().turns = {{.degrees = 90, .about = {0, 9, 30}}};
  scene.render.samples = samples;
  return scene;
}

/// The edge, and a ball of its material behind the camera: where either of them turns, the kernels are the
/// same.
SceneDescription edge_and_ball() {
  SceneDescription scene = moving_edge::scene();
  scenes::place(scene, SphereShape{1}, scene.objects.front().material,
                glm::translate(glm::dmat4(1), {0, 0, 100}));
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

TEST_CASE("an edge that turns is a ramp in the angle, however far it turns") {
  SceneDescription scene = edge_and_ball();  // from x = 0 to the right
  scene.render.samples = 64;
  for (const double degrees : {90.0, -240.0, 540.0}) {
    scene.objects.front().turns = {{.axis = {0, 0, 2}, .degrees = degrees, .about = {0, 0, -5}}};
    // The part of the time in which a direction at `angle` is less than a quarter turn from the edge's
    // middle.
    const auto covered = [&](double angle) {
      int count = 0;
      for (int i = 0; i < 1000; ++i)
        count += std::cos(glm::radians(angle - (i + 0.5) / 1000 * degrees)) > 0 ? 1 : 0;
      return count / 1000.0;
    };
    on_picture_devices([&](const DeviceInfo& device) {
      const Image image = scenes::render_on(device, scene).image;
      for (int angle = 5; angle < 360; angle += 10) {
        double sum = 0;
        const double from = moving_edge::size / 2.0;
        for (int radius = 14; radius < 30; ++radius)
          sum += double(image.pixel(int(from + radius * std::cos(glm::radians(double(angle)))),
                                    int(from - radius * std::sin(glm::radians(double(angle)))))[0]);
        INFO(degrees << " degrees, at " << angle);
        CHECK(std::abs(sum / 16 - covered(angle)) < 0.03);
      }
    });
  }
}

TEST_CASE("a ball that grows has a rim as wide as it grows") {
  SceneDescription scene = edge_and_ball();
  scene.render.samples = 64;
  scene.objects.front().world_from_object = glm::translate(glm::dmat4(1), {0, 0, 100});
  scene.objects.back().world_from_object =
      glm::translate(glm::dmat4(1), {0, 0, -20}) * glm::scale(glm::dmat4(1), dvec3(1.5));
  scene.objects.back().turns = {{.degrees = 90, .about = {0, 0, -20}, .growth = 2}};
  on_picture_devices([&](const DeviceInfo& device) {
    const Image image = scenes::render_on(device, scene).image;
    const int middle = moving_edge::size / 2;
    for (int x = 0; x < middle; ++x) {
      const double off = (x + 0.5) / moving_edge::pixels_a_unit(scene),
                   radius = 20 * std::sin(std::atan(off));
      const double expected = std::clamp(1 - (radius / 1.5 - 1), 0.0, 1.0);
      double mean = 0;
      for (const int row : {middle - 1, middle})
        for (const int column : {middle + x, middle - 1 - x}) mean += double(image.pixel(column, row)[0]) / 4;
      INFO(x);
      CHECK(std::abs(mean - expected) < 0.05);
    }
  });
}

TEST_CASE("a picture of turning things is the mean of still ones, and the same for every tile and group") {
  SceneDescription scene = turning_things();
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
    CHECK(difference(blurred, scenes::render_on(device, scene).image).most < 0.005);
    scene.render.tracer = Tracer::automatic;
    scene.render.integrator = "path";
    scene.render.max_depth = 3;
    const BlockDifference paths =
        difference(scenes::render_on(device, scene).image, mean_of_stills(device, scene, 16, 16));
    CHECK(paths.most < 0.1);
    CHECK(paths.mean < 0.012);
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

TEST_CASE("the pattern of a thing's opacity moves with it for the lamps' light, too") {
  const TemporaryFolder folder;
  const SceneDescription scene = load_scene(folder.write("holes.json", R"({
    "camera": {"position": [-0.2, 1.4, 4], "target": [-0.4, -0.2, 0.5], "fov": 20},
    "image": {"width": 16, "height": 16},
    "render": {"integrator": "path", "samples": 64, "max_depth": 64, "path": {"lights": "lights"}},
    "environment": {"type": "gradient", "top": [1, 1, 1], "bottom": [1, 1, 1]},
    "textures": {"holes": {"type": "checker", "size": 0.3, "colors": [[1, 1, 1], [0.2, 0.2, 0.2]]}},
    "materials": {"paper": {"diffuse": 1, "ambient": 0, "opacity": "holes"}},
    "objects": [{"type": "box", "material": "paper", "moves_by": [0.2, 0, 0],
                 "transform": [{"scale": 0.7}, {"translate": [-0.36, -0.25, 0.5]}]}]})"));
  on_picture_devices([&](const DeviceInfo& device) {
    const Image image = scenes::render_on(device, scene).image;
    double sum = 0;
    for (std::size_t i = 0; i < image.data.size(); i += 4) sum += double(image.data[i]);
    CHECK(sum * 4 / double(image.data.size()) == Approx(1).epsilon(0.03));
  });
}
