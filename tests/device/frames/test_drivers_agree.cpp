// Other drivers draw what the first device does, scene by scene: between them the scenes have every feature
// of the kernels, so that each driver's compiler meets all of their text. What the pictures should show is
// what the other tests ask of the first device.
#include <map>

#include "base/image_compare.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "render/render.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;

namespace {

struct Shipped {
  const char* name;
  std::vector<std::string> overrides = {};  // for features that the scene itself does not have
};

const std::vector<Shipped>& scenes_of_all_features() {
  static const std::vector<Shipped> list = {
      {"fractal_in_ice", {}},
      {"fractal_light_all", {"/world/fog={\"color\": [0.5, 0.6, 0.7], \"density\": 0.05}"}},
      {"environment", {"/render/filter=\"gaussian\""}},
      {"lens", {"/render/sampler=\"sobol\""}},
      {"soft_light", {}},
      {"patterns", {}},
      {"glass_path", {}},
      {"fractal_path", {}},
  };
  return list;
}

SceneDescription small(const Shipped& shipped) {
  std::vector<std::string> settings = {"/image/width=40", "/image/height=30", "/render/samples=1",
                                       "/render/max_depth=4"};
  settings.insert(settings.end(), shipped.overrides.begin(), shipped.overrides.end());
  return load_scene(std::string(SUNDOG_SOURCE_DIR) + "/scenes/" + shipped.name + ".json", settings);
}

}  // namespace

TEST_CASE("the scenes that are drawn on every driver have every feature of the kernels") {
  std::map<std::string, bool> found;
  for (const Shipped& shipped : scenes_of_all_features()) {
    const SceneFeatures features = compile(small(shipped)).features;
#define SUNDOG_FIND_FEATURE(type, definition, name) found[#name] |= features.name != 0;
    SCENE_FEATURES(SUNDOG_FIND_FEATURE)
#undef SUNDOG_FIND_FEATURE
  }
  for (const auto& [feature, there] : found) {
    INFO(feature);
    CHECK(there);
  }
}

TEST_CASE("every driver draws the same pictures, but for few pixels at edges") {
  const DeviceInfo& first = test_devices().front();
  for (const DeviceInfo& other : test_devices()) {
    if (other.platform == first.platform) continue;
    for (const Shipped& shipped : scenes_of_all_features())
      DYNAMIC_SECTION(other.label() << ", " << shipped.name) {
        const SceneDescription scene = small(shipped);
        const ImageDifference difference = compare_images(scenes::render_on(other, scene).image,
                                                          scenes::render_on(first, scene).image, 0.02);
        CHECK(difference.non_finite == 0);
        CHECK(difference.over_tolerance * 50 <= difference.pixels);
      }
  }
}
