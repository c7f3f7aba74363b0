// Thin solids that stand askew are in several leaves of the scene's tree: they are met, and crossed, once.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/image_compare.h"
#include "catch.h"
#include "devices.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"

using namespace sundog;

namespace {

/// A rod, or two of one rod end to end, and small balls out of sight; without these there is no tree.
SceneDescription rods(const std::string& material, bool two, int balls) {
  const auto rod = [](double from, double to) {
    return fmt::format(
        R"({{"type": "box", "min": [-0.12, {}, -0.12], "max": [0.12, {}, 0.12], "material": "rod",
      "transform": [{{"rotate": {{"axis": [0, 0, 1], "degrees": 45}}}}, {{"rotate": {{"axis": [1, 0, 0], "degrees": 35}}}}]}})",
        from, to);
  };
  std::string objects = two ? rod(-3, 2) + ", " + rod(2, 3) : rod(-3, 3);
  for (int i = 0; i < balls; ++i)
    objects += fmt::format(
        R"(, {{"type": "sphere", "radius": 0.05, "center": [{}, -1.8, 7], "material": "rod"}})", 0.4 * i - 2);
  const nlohmann::json document = parse_json(fmt::format(R"({{"image": {{"width": 80, "height": 60,
        "background": {{"bottom": [0.2, 0.2, 0.3], "top": [0.9, 0.9, 1]}}}},
      "camera": {{"position": [0, 0, 6], "target": [0, 0, 0], "fov": 40}}, "render": {{"samples": 2, "max_depth": 10}},
      "lights": [{{"type": "point", "position": [3, 5, 5]}}],
      "media": {{"green": {{"ior": 1.5, "absorption": [0.5, 0.1, 0.5]}}}},
      "materials": {{"rod": {}}}, "objects": [{}]}})",
                                                         material, objects),
                                             "test.json");
  const JsonContext context{"test.json"};
  return read_scene(JsonValue(document, context));
}

}  // namespace

TEST_CASE("a thin solid that stands askew looks the same in a tree of many leaves as alone, by each tracer") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* material : {R"({"diffuse": 0.8})", R"({"type": "dielectric", "medium": "green"})"})
      for (const bool two : {false, true}) {
        CAPTURE(material, two);
        const Image alone = scenes::render_on(device, rods(material, two, 0)).image;
        for (const Tracer tracer : {Tracer::wide, Tracer::compact}) {
          if (device.native_vector_width <= 1 && tracer == Tracer::wide) continue;
          SceneDescription scene = rods(material, two, 12);
          scene.render.tracer = tracer;
          const RenderResult among = scenes::render_on(device, scene);
          CHECK(among.counts[COUNT_STRAY_EXIT] == 0);
          const ImageDifference d = compare_images(alone, among.image, 0.02);
          CHECK(d.over_tolerance <= 2);
        }
      }
  });
}
