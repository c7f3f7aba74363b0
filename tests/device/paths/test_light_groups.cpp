// AOVs of light groups: each has the light of its lamps alone, and they sum to the picture.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "path_testing.h"
#include "render/film/group_names.h"
#include "render/session/render_session.h"
#include "same_bits.h"
#include "scene/light_groups.h"
#include "scene/load.h"
#include "temporary_folder.h"

using namespace sundog;
using namespace sundog::paths;

namespace {

/// A lamp, a spot, a mesh and a ball that shine, a sky with a sun, another sun, in fog that scatters.
SceneDescription scene_of_groups() {
  const TemporaryFolder folder;
  folder.write("board.obj", "v -1 2.5 -1\nv 1 2.5 -1\nv 0 3 -1.5\nf 1 2 3\n");
  return load_scene(folder.write("scene.json", R"({
    "camera": {"position": [0, 1.5, 6], "target": [0, 0.7, 0], "fov": 40},
    "image": {"width": 24, "height": 16}, "render": {"integrator": "path", "samples": 16, "max_depth": 5},
    "world": {"fog": {"color": [0.6, 0.7, 0.8], "density": 0.03, "anisotropy": 0.3}},
    "environment": {"type": "sky", "sun": {"altitude": 30, "azimuth": 20, "size": 3}, "group": "sky"},
    "lights": [
      {"type": "sphere", "position": [-2, 2, 1], "radius": 0.3, "intensity": 30, "group": "key"},
      {"type": "spot", "position": [2, 3, 2], "target": [0, 0, 0], "intensity": 3, "group": "fill"},
      {"type": "directional", "direction": [-1, -1, -1], "angle": 2, "intensity": 0.5, "group": "key"},
      {"type": "point", "position": [0, 4, 0], "intensity": 0.4}],
    "materials": {
      "floor": {"color": [0.7, 0.7, 0.7], "diffuse": 1},
      "mirror": {"color": [0, 0, 0], "reflection": 0.9},
      "glass": {"type": "dielectric", "ior": 1.5},
      "screen": {"color": [0, 0, 0], "emission": [3, 2, 1], "group": "screen"},
      "ember": {"color": [0, 0, 0], "emission": [0.5, 0.1, 0]}},
    "meshes": {"board": {"file": "board.obj"}},
    "objects": [
      {"type": "plane", "material": "floor"},
      {"type": "mesh", "mesh": "board", "material": "screen"},
      {"type": "sphere", "center": [-0.8, 0.5, 0], "radius": 0.5, "material": "mirror"},
      {"type": "sphere", "center": [0.5, 0.5, 0.5], "radius": 0.5, "material": "glass"},
      {"type": "sphere", "center": [1.6, 0.3, 0.5], "radius": 0.3, "material": "ember"}]})"));
}

RenderResult render_groups(const DeviceInfo& device, const SceneDescription& scene) {
  RenderOptions options;
  options.aovs = with_group_numbers({light_groups_aov}, light_groups(scene));
  RenderResult result = scenes::render_on(device, scene, options);
  result.aovs = without_group_numbers(std::move(result.aovs));
  return result;
}

/// The scene with the lights of that group alone; "rest": those in none.
SceneDescription only(SceneDescription scene, const std::string& group) {
  const std::string wanted = group == "rest" ? "" : group;
  for (LightDescription& light : scene.lights)
    if (light.group != wanted) light.intensity = 0;
  for (MaterialDescription& material : scene.materials)
    if (material.group != wanted) material.emission = dvec3(0);
  if (scene.environment.group != wanted) scene.environment.intensity = 0;
  return scene;
}

double mean(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % static_cast<std::size_t>(image.channels) < 3) sum += double(image.data[i]);
  return sum / (3.0 * image.width * image.height);
}

}  // namespace

TEST_CASE("the light of groups sums to the picture, which it leaves as it is") {
  const SceneDescription scene = scene_of_groups();
  CHECK(light_groups(scene) == std::vector<std::string>{"fill", "key", "screen", "sky"});
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult result = render_groups(device, scene);
    CHECK(result.aovs.size() == 5);
    CHECK(same_bits(result.image, scenes::render_on(device, scene).image));
    double sum = 0;
    for (const auto& [name, image] : result.aovs) sum += mean(image);
    CHECK(sum == Approx(mean(result.image)).epsilon(1e-4));
  });
}

TEST_CASE("a group's image is the scene with its lights alone") {
  SceneDescription scene = scene_of_groups();
  scene.render.samples = 256;
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult result = render_groups(device, scene);
    for (const char* group : {"fill", "key", "screen", "sky", "rest"}) {
      const double alone = mean(scenes::render_on(device, only(scene, group)).image);
      INFO(group);
      CHECK(mean(result.aovs.at(std::string("light_") + group)) == Approx(alone).epsilon(0.03));
    }
  });
}

TEST_CASE("a session balances groups without drawing anew") {
  const SceneDescription scene = scene_of_groups();
  const std::vector<glm::vec3> balance{glm::vec3(1), {2, 0.5f, 0}, glm::vec3(1), glm::vec3(0)};
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult whole = render_groups(device, scene);
    RenderSession session(std::vector<DeviceInfo>{device});
    SessionSettings settings;
    settings.light_groups = true;
    const Generation drawn = session.start(std::make_shared<const SceneDescription>(scene), settings);
    session.wait();
    CHECK(same_bits(*session.snapshot().picture, whole.image));
    session.set_balance(balance);
    const Snapshot balanced = session.snapshot();
    CHECK(balanced.generation == drawn);
    CHECK(balanced.state == SessionState::settled);
    const std::vector<std::string> names{"rest", "fill", "key", "screen", "sky"};
    for (int y = 0; y < whole.image.height; ++y)
      for (int x = 0; x < whole.image.width; ++x)
        for (int c = 0; c < 3; ++c) {
          float right = 0;
          for (std::size_t k = 0; k < names.size(); ++k)
            right +=
                (k < balance.size() ? balance[k][c] : 1) * whole.aovs.at("light_" + names[k]).pixel(x, y)[c];
          if (!(std::abs(balanced.picture->pixel(x, y)[c] - right) <= 1e-6f + 1e-5f * right))
            FAIL_CHECK(x << ", " << y << ": " << balanced.picture->pixel(x, y)[c] << " for " << right);
        }
    session.set_balance({});
    CHECK(same_bits(*session.snapshot().picture, whole.image));
  });
}

TEST_CASE("a session without groups to keep apart draws as without the setting") {
  SceneDescription scene = scene_of_groups();
  scene.render.integrator = "whitted";
  const DeviceInfo& device = test_devices().front();
  RenderSession session(std::vector<DeviceInfo>{device});
  SessionSettings settings;
  settings.light_groups = true;
  session.set_balance({glm::vec3(3)});
  session.start(std::make_shared<const SceneDescription>(scene), settings);
  session.wait();
  CHECK(same_bits(*session.snapshot().picture, scenes::render_on(device, scene).image));
}

TEST_CASE("AOVs of groups are refused where the scene has no such group, or where they cannot be") {
  const std::vector<std::string> groups{"key"};
  CHECK(with_group_numbers({"depth", "light_key"}, groups) ==
        std::vector<std::string>{"depth", "light_key@1"});
  CHECK(with_group_numbers({"light_groups", "light_key"}, groups) ==
        std::vector<std::string>{"light_rest@0", "light_key@1"});
  CHECK_THROWS_AS(with_group_numbers({"light_fill"}, groups), UsageError);
  CHECK_THROWS_AS(with_group_numbers({"light_key", "sky"}, groups), UsageError);
}
