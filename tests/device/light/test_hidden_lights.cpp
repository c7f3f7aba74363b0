// Lights that the camera does not see, and such that no ray sees: "visible" and "hidden".
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "catch.h"
#include "devices.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"

using namespace sundog;

namespace {

enum class Shown { to_all, off_camera, to_none };

/// The light that a pixel sees straight ahead, or in the mirror that stands there.
double seen(const DeviceInfo& device, const char* integrator, const std::string& light, Shown shown,
            bool mirrored) {
  const char* keys = shown == Shown::to_all       ? ""
                     : shown == Shown::off_camera ? R"(, "visible": false)"
                                                  : R"(, "hidden": true)";
  const bool sky = light.find("gradient") != std::string::npos;
  const std::string text = fmt::format(
      R"({{"camera": {{"position": [0, 0, {0}], "target": [0, 0, {1}], "fov": 1}},
      "image": {{"width": 4, "height": 4, "background": [0.25, 0.25, 0.25]}},
      "render": {{"integrator": "{2}", "samples": 4}},
      {3}
      "materials": {{"mirror": {{"diffuse": 0, "ambient": 0, "reflection": 1}}}},
      "objects": [{{"type": "box", "min": [-9, -9, 5], "max": [9, 9, 6], "material": "mirror"}}]}})",
      mirrored ? -1 : 1, mirrored ? 5 : -5, integrator,
      fmt::format(fmt::runtime(sky ? R"("environment": {{{}{}}},)" : R"("lights": [{{{}{}}}],)"), light,
                  keys));
  const nlohmann::json document = parse_json(text, "test.json");
  const JsonContext context{"test.json"};
  const Image image = scenes::render_on(device, read_scene(JsonValue(document, context))).image;
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4) sum += double(image.data[i]);
  return sum * 4 / double(image.data.size());
}

}  // namespace

TEST_CASE("an invisible light is hidden from the camera alone, a hidden one from all rays") {
  struct Case {
    const char* light;
    double radiance;
  };
  // Each seen along -z from the origin. The sun's radiance is its irradiance over pi sin^2 of half its angle.
  const Case cases[] = {
      {R"("type": "rectangle", "position": [0, 0, -5], "direction": [0, 0, 1], "size": [2, 2], "intensity": 3)",
       3},
      {R"("type": "disk", "position": [0, 0, -5], "direction": [0, 0, 1], "intensity": 3)", 3},
      {R"("type": "sphere", "position": [0, 0, -5], "intensity": 3)", 3},
      {R"("type": "directional", "direction": [0, 0, 1], "angle": 60, "intensity": 1)", 4 + 0.25},
      {R"("type": "gradient", "bottom": [0.75, 0.75, 0.75], "top": [0.75, 0.75, 0.75])", 0.75}};
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* integrator : {"whitted", "path"})
      for (const auto& [light, radiance] : cases) {
        CAPTURE(integrator, light);
        CHECK(seen(device, integrator, light, Shown::to_all, false) == Approx(radiance).epsilon(1e-4));
        CHECK(seen(device, integrator, light, Shown::off_camera, false) == Approx(0.25));
        CHECK(seen(device, integrator, light, Shown::to_none, false) == Approx(0.25));
        CHECK(seen(device, integrator, light, Shown::to_all, true) == Approx(radiance).epsilon(1e-4));
        CHECK(seen(device, integrator, light, Shown::off_camera, true) == Approx(radiance).epsilon(1e-4));
        CHECK(seen(device, integrator, light, Shown::to_none, true) == Approx(0.25));
      }
  });
}
