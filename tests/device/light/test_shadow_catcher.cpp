// Shadow catchers: their alpha is the part of the lamps' light that shadows take.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "catch.h"
#include "devices.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"

using namespace sundog;
using nlohmann::json;

namespace {

// A wall beside the picture on a floor, under a lamp, a weaker one, a sun and a sky, seen from above.
const char* const stage = R"({
  "camera": {"position": [0, 6, 0.01], "target": [0, 0, 0], "fov": 35},
  "image": {"width": 16, "height": 12, "transparent": true},
  "render": {"integrator": "path", "samples": 256, "max_depth": 1},
  "environment": {"type": "gradient", "top": [0.2, 0.25, 0.3], "bottom": [0.1, 0.1, 0.1]},
  "lights": [{"type": "rectangle", "position": [-4, 5, 0], "target": [0, 0, 0], "size": [1, 1], "intensity": 20},
    {"type": "sphere", "position": [4, 3, 1], "radius": 0.3, "intensity": 4},
    {"type": "directional", "direction": [-0.2, -1, -0.5], "intensity": 0.3, "angle": 3}],
  "materials": {"floor": {"color": [0.5, 0.5, 0.5], "diffuse": 1, "ambient": 0},
    "black": {"diffuse": 0, "ambient": 0}},
  "objects": [{"type": "plane", "material": "floor"},
    {"type": "box", "min": [-2.6, 0, -3], "max": [-2.2, 3, 3], "material": "black"}]})";

Image render(const DeviceInfo& device, const json& document) {
  const JsonContext context{"test.json"};
  return scenes::render_on(device, read_scene(JsonValue(document, context))).image;
}

}  // namespace

TEST_CASE("a shadow catcher's alpha is the part of the lamps' light that shadows take") {
  on_picture_devices([&](const DeviceInfo& device) {
    json catching = json::parse(stage), shadowed = catching, open = catching;
    catching["materials"]["floor"]["shadow_catcher"] = true;
    open["objects"].erase(1);
    const Image caught = render(device, catching), with = render(device, shadowed),
                without = render(device, open);
    double darkest = 0, lightest = 1;
    for (int tile = 0; tile < 4 * 3; ++tile) {  // of 4 x 4 pixels
      double alpha = 0, light = 0, all = 0, color = 0;
      for (int i = 0; i < 16; ++i) {
        const auto pixel = static_cast<std::size_t>((tile / 4 * 4 + i / 4) * 16 + tile % 4 * 4 + i % 4) * 4;
        alpha += caught.data[pixel + 3] / 16.0;
        color += caught.data[pixel] / 16.0;
        light += with.data[pixel + 1] / 16.0;
        all += without.data[pixel + 1] / 16.0;
      }
      INFO("tile " << tile << ": alpha " << alpha << ", light " << light << " of " << all);
      CHECK(color == 0);
      CHECK(alpha == Approx(1 - light / all).margin(0.03));
      darkest = std::max(darkest, alpha), lightest = std::min(lightest, alpha);
    }
    CHECK(darkest > 0.4);
    CHECK(lightest < 0.1);
  });
}

TEST_CASE("without --transparent a shadow catcher darkens the background, and others see its material") {
  on_picture_devices([&](const DeviceInfo& device) {
    json scene = json::parse(stage);
    scene["materials"]["floor"]["shadow_catcher"] = true;
    const Image alpha = render(device, scene);
    scene["image"]["transparent"] = false;
    scene["image"]["background"] = {0.5, 0.5, 0.5};
    scene["environment"]["visible"] = false;
    const Image over = render(device, scene);
    for (std::size_t i = 0; i < over.data.size(); i += 4)
      CHECK(over.data[i] == Approx(0.5 * (1 - alpha.data[i + 3])).margin(1e-5));
    // A mirror over the floor shows the floor, lit.
    scene["materials"]["black"]["reflection"] = 1;
    scene["render"]["max_depth"] = 2;
    scene["objects"][1] = {{"type", "box"}, {"min", {-9, 2, -9}}, {"max", {9, 3, 9}}, {"material", "black"}};
    scene["camera"] = {{"position", {0, 1, 0}}, {"target", {0, 2, 0.01}}, {"fov", 20}};
    scene["lights"] = {{{"type", "point"}, {"position", {0, 1.5, 0}}, {"intensity", 3}}};
    scene["environment"] = {{"type", "gradient"}, {"intensity", 0}};
    CHECK(render(device, scene).data[0] > 0.1);
  });
}

TEST_CASE("the far wall of a ball that catches shadows lies in the shadow of the near one") {
  json scene = json::parse(stage);
  scene["camera"]["fov"] = 0.01;
  scene["lights"] = {{{"type", "directional"}, {"direction", {0, -1, 0}}}};
  scene.erase("environment");
  scene["materials"]["floor"]["shadow_catcher"] = true;
  on_picture_devices([&](const DeviceInfo& device) {
    for (const json& ball : {json{{"type", "sphere"}}, json{{"type", "fractal"}, {"formula", "sphere"}}}) {
      scene["objects"] = {ball};
      scene["objects"][0]["material"] = "floor";
      const Image seen = render(device, scene);
      CHECK(seen.data[0] == 0);
      CHECK(seen.data[3] == 1);
    }
  });
}

TEST_CASE("a shadow catcher needs paths and a surface without an inside") {
  const auto refusal = [](const char* material, const char* integrator) {
    json scene = json::parse(stage);
    scene["render"]["integrator"] = integrator;
    scene["materials"]["floor"] = json::parse(material);
    try {
      render(test_devices().front(), scene);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(
      refusal(R"({"shadow_catcher": true})", "whitted"),
      ContainsSubstring("/materials/floor/shadow_catcher") && ContainsSubstring("set /render/integrator"));
  CHECK_THAT(refusal(R"({"type": "dielectric", "ior": 1.5, "shadow_catcher": true})", "path"),
             ContainsSubstring("/materials/floor/shadow_catcher"));
}
