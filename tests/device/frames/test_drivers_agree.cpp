// Other drivers draw what the first device does, scene by scene: between them the scenes have every feature
// of the kernels, so that each driver's compiler meets all of their text. What the pictures should show is
// what the other tests ask of the first device.
#include <map>
#include <set>

#include "base/image_compare.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "render/render.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;

namespace {

/// Small scenes which between them have every feature of the kernels but those below.
const std::vector<std::string>& scenes_of_all_features() {
  static const std::vector<std::string> list = {"glass", "fields", "lamps", "layers", "paths"};
  return list;
}

SceneDescription scene_named(const std::string& name) {
  return load_scene(SUNDOG_SOURCE_DIR "/tests/support/every_feature/" + name + ".json");
}

/// Compared elsewhere: of images and textures, by small kernels on every driver (test_textures, test_relief,
/// test_parallax); and those that some drivers compile for half a minute each, of the first device
/// (test_touching, test_fields_in_scene, test_caustics, test_layer_maps, test_gltf_layers).
const std::set<std::string> tried_elsewhere = {
    "maps",          "fuzz_maps",     "surface_coordinates", "relief",        "parallax",
    "metal_rough",   "layer_maps",    "coat_maps",           "specular_maps", "texture_mappings",
    "texture_kinds", "texture_stack", "map_slots",           "texel_formats", "texel_pages",
    "extra_uvs",     "touching",      "two_sided_fields",    "near_fields",   "caustics"};

}  // namespace

TEST_CASE(
    "the scenes that are drawn on every driver have every feature of the kernels that is not tried "
    "elsewhere") {
  std::map<std::string, bool> found;
  for (const std::string& name : scenes_of_all_features()) {
    const SceneFeatures features = compile(scene_named(name)).features;
#define SUNDOG_FIND_FEATURE(type, definition, name, effect) found[#name] |= features.name != 0;
    SCENE_FEATURES(SUNDOG_FIND_FEATURE)
#undef SUNDOG_FIND_FEATURE
  }
  for (const auto& [feature, there] : found) {
    INFO(feature);
    CHECK(there != tried_elsewhere.contains(feature));
  }
}

TEST_CASE("every driver draws the same pictures, but for few pixels at edges") {
  const DeviceInfo& first = test_devices().front();
  for (const DeviceInfo& other : test_devices()) {
    if (other.platform == first.platform) continue;
    for (const std::string& name : scenes_of_all_features()) DYNAMIC_SECTION(other.label() << ", " << name) {
        const SceneDescription scene = scene_named(name);
        const ImageDifference difference = compare_images(scenes::render_on(other, scene).image,
                                                          scenes::render_on(first, scene).image, 0.02);
        CHECK(difference.non_finite == 0);
        CHECK(difference.over_tolerance * 50 <= difference.pixels);
      }
  }
}
