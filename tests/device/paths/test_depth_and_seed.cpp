// How deep paths go, the seed of their numbers, and the limit of samples.
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "path_testing.h"
#include "same_bits.h"
#include "scene/integrators.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"

using namespace sundog;
using namespace sundog::paths;

namespace {

/// A room whose walls shine with 1 and return the part `albedo` of all light: 1 / (1 - albedo) everywhere.
SceneDescription shining_room(double albedo, int depth) {
  SceneDescription scene = path_scene({0, 0, 0}, {0.3, 0.2, 1}, 64);
  scene.render.max_depth = depth;
  const int mesh = add_room(scene), walls = add_matte(scene, albedo);
  scene.materials.back().emission = dvec3(1);
  scenes::place(scene, MeshShape{mesh}, walls);
  return scene;
}

SceneDescription lit_plane(int seed, u32 sampler, int samples = 4) {
  SceneDescription scene = path_scene({0, 0.6, 3}, {0, 0, 0}, samples);
  scene.render.seed = seed;
  scene.render.sampler = sampler;
  scenes::place(scene, PlaneShape{}, add_matte(scene, 0.6));
  scene.lights.push_back(lamp(LightType::rectangle, {0, 0.8, 0}, 2));
  scene.lights.back().size = {1.2, 0.7};
  return scene;
}

}  // namespace

TEST_CASE("paths of a room that returns nearly all light end by chance alone") {
  on_picture_devices([&](const DeviceInfo& device) {
    check_mean(mean_on(device, shining_room(0.98, depth_cap)), 50);
    const Mean shallow = mean_on(device, shining_room(0.98, 64));
    CHECK(shallow.value.x < 40);  // 50 (1 - 0.98^65)
  });
}

TEST_CASE("without max_depth paths may have 1024 surfaces, with it as many as it says; whitted has 8") {
  const auto depth = [](const std::string& render) {
    const JsonContext context{"test.json"};
    const nlohmann::json document =
        parse_json(R"({"camera": {"position": [0, 0, 1], "target": [0, 0, 0]}, "objects": [], "render": )" +
                       render + "}",
                   "test.json");
    return read_scene(JsonValue(document, context)).render.max_depth;
  };
  CHECK(depth("{}") == 8);
  CHECK(depth(R"({"integrator": "path"})") == 1024);
  CHECK(depth(R"({"integrator": "path", "max_depth": 4000})") == 4000);
  CHECK(depth(R"({"integrator": "path", "max_depth": 3})") == 3);
}

TEST_CASE("surfaces that light passes straight cost no depth, whichever way paths find the light") {
  MaterialDescription half, pane;
  half.diffuse = half.ambient = half.specular = dvec3(0);
  half.opacity = 0.5;
  pane = half, pane.opacity = 1, pane.transmission = dvec3(0.5);
  for (const MaterialDescription& above : {half, pane})
    for (const u32 strategy : {STRATEGY_MIS, STRATEGY_LIGHTS, STRATEGY_SURFACES})
      for (const int depth : {1, 2, 8}) {
        SceneDescription scene = path_scene({0, 0.5, 0.5}, {0, 0, 0});
        scene.render.light_strategy = strategy, scene.render.max_depth = depth;
        scenes::place(scene, PlaneShape{}, add_matte(scene, 0.8));
        scene.materials.push_back(above);
        for (const double height : {1.0, 2.0})
          scenes::place(scene, PlaneShape{}, 1, glm::translate(glm::dmat4(1), {0, height, 0}));
        scene.environment.type = EnvironmentType::gradient;
        scene.environment.bottom = scene.environment.top = dvec3(1);
        on_picture_devices([&](const DeviceInfo& device) {
          INFO("strategy " << strategy << ", depth " << depth);
          check_mean(mean_on(device, scene), 0.8 * 0.25);
        });
      }
}

TEST_CASE("samples brighter than max_component keep their hue") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* integrator : {"whitted", "path"}) {
      SceneDescription scene = shining_room(0, 4);
      scene.render.integrator = integrator;
      scene.materials.back().emission = {6, 3, 1.5};
      CHECK(mean_on(device, scene).value == dvec3(6, 3, 1.5));
      scene.render.max_component = 8;
      CHECK(mean_on(device, scene).value == dvec3(6, 3, 1.5));
      scene.render.max_component = 2;
      CHECK(mean_on(device, scene).value == dvec3(2, 1, 0.5));
    }
  });
}

TEST_CASE("seeds have noise of their own, whose mean is that of more samples") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const u32 sampler : {u32{SAMPLER_AUTO}, u32{SAMPLER_SOBOL}, u32{SAMPLER_INDEPENDENT},
                              u32{SAMPLER_STRATIFIED}, u32{SAMPLER_BLUE_NOISE}}) {
      INFO("sampler " << sampler);
      const auto picture = [&](int seed, int samples) {
        return scenes::render_on(device, lit_plane(seed, sampler, samples)).image;
      };
      const Image truth = picture(0, 4096), one = picture(0, 4);
      CHECK(same_bits(one, picture(0, 4)));
      CHECK_FALSE(same_bits(one, picture(1, 4)));
      const auto error = [&](const std::vector<double>& sum, double count) {
        double squares = 0;
        for (std::size_t i = 0; i < sum.size(); i += 4)
          squares += std::pow(sum[i] / count - double(truth.data[i]), 2);
        return std::sqrt(4 * squares / double(sum.size()));
      };
      std::vector<double> sum(truth.data.size(), 0.0);
      double alone = 0;
      constexpr int seeds = 16;
      for (int seed = 1; seed <= seeds; ++seed) {
        const Image each = picture(seed, 4);
        std::vector<double> own(each.data.begin(), each.data.end());
        alone += error(own, 1) / seeds;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
      }
      const double together = error(sum, seeds);
      INFO(alone << " alone, " << together << " together");
      CHECK(together < 0.4 * alone);  // a quarter, but for chance
      CHECK(together > 0.1 * alone);
    }
  });
}

TEST_CASE("a seed changes what whitted sends to lamps with an extent") {
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = lit_plane(0, SAMPLER_AUTO);
    scene.render.integrator = "whitted";
    scenes::place(scene, SphereShape{0.1}, 0);
    const Image one = scenes::render_on(device, scene).image;
    scene.render.seed = 7;
    CHECK_FALSE(same_bits(one, scenes::render_on(device, scene).image));
  });
}
