// Fields of glass and liquid in each other: no ray loses count of what it is inside of.
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

/// Glass, and something else of a lower priority, before a gradient.
SceneDescription in_glass(const std::string& glass, const std::string& other) {
  const nlohmann::json document = parse_json(fmt::format(R"({{"image": {{"width": 80, "height": 80,
      "background": {{"bottom": [0.1, 0.3, 0.9], "top": [1, 0.8, 0.3]}}}},
    "camera": {{"position": [0.3, 0.6, 4.5], "target": [0, 0, 0], "fov": 30}}, "render": {{"max_depth": 12}},
    "lights": [{{"type": "ambient"}}, {{"type": "point", "position": [-4, 6, 4]}}],
    "media": {{"glass": {{"ior": 1.5, "priority": 2}}, "liquid": {{"ior": 1.33, "priority": 1, "absorption": [0.1, 0.5, 1]}}}},
    "materials": {{"matte": {{"color": [0.8, 0.5, 0.2]}}, "glass": {{"type": "dielectric", "medium": "glass"}},
      "liquid": {{"type": "dielectric", "medium": "liquid"}}}},
    "objects": [{{{}, "material": "glass"}}, {{{}, "material": "liquid"}}]}})",
                                                         glass, other),
                                             "test.json");
  const JsonContext context{"test.json"};
  return read_scene(JsonValue(document, context));
}

std::string formula(const std::string& distance, double x = 0) {
  return fmt::format(R"("type": "formula", "distance": "{}", "transform": [{{"translate": [{}, 0, 0]}}],
    "interval": {{"min": [-1.2, -1.2, -1.2], "max": [1.2, 1.2, 1.2]}})",
                     distance, x);
}

std::string ball(double radius, double x) {
  return fmt::format(R"("type": "sphere", "radius": {}, "center": [{}, 0, 0])", radius, x);
}

void check_counts(const RenderResult& result) {
  CHECK(result.counts[COUNT_MEDIA_STACK_OVERFLOW] == 0);
  CHECK(result.counts[COUNT_STRAY_EXIT] == 0);
  CHECK(result.counts[COUNT_SHADOW_LIMIT] == 0);
}

}  // namespace

TEST_CASE(
    "overlapping fields of glass look like the exact solids, and every ray leaves what it has entered") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double apart : {0.3, 0.6, 0.9}) {
      CAPTURE(apart);
      const SceneDescription fields =
          in_glass(formula("length(p) - 0.7", -apart / 2), formula("length(p) - 0.7", apart / 2));
      const SceneDescription exact = in_glass(ball(0.7, -apart / 2), ball(0.7, apart / 2));
      const RenderResult result = scenes::render_on(device, fields);
      check_counts(result);
      const ImageDifference d = compare_images(result.image, scenes::render_on(device, exact).image, 0.02);
      CHECK(d.over_tolerance <= d.pixels / 200);
    }
  });
}

TEST_CASE("paths that scatter in glass before the wall of liquid within it are outside of the liquid") {
  const auto mean_of = [](const DeviceInfo& device, SceneDescription scene) {
    scene.render.integrator = "path";
    scene.render.samples = 64;
    scene.media.at(1).scattering = dvec3(2);
    const RenderResult result = scenes::render_on(device, scene);
    CHECK(result.counts[COUNT_STRAY_EXIT] < 10);  // of 400,000 paths: some scatter on a wall
    dvec3 sum(0);
    const auto channels = static_cast<std::size_t>(result.image.channels);
    for (std::size_t i = 0; i < result.image.data.size(); i += channels)
      sum += dvec3(result.image.data[i], result.image.data[i + 1], result.image.data[i + 2]);
    return sum * (double(channels) / double(result.image.data.size()));
  };
  on_picture_devices([&](const DeviceInfo& device) {
    const std::string closed = "length(p) - 0.7";
    const dvec3 fields = mean_of(device, in_glass(formula(closed, -0.3), formula(closed, 0.3)));
    const dvec3 exact = mean_of(device, in_glass(ball(0.7, -0.3), ball(0.7, 0.3)));
    for (int c = 0; c < 3; ++c) CHECK(fields[c] == Approx(exact[c]).epsilon(0.01));
  });
}

TEST_CASE("in a white surrounding, light that starts anywhere inside a fractal leaves it") {
  const auto white = [](const std::string& medium, const std::string& inside) {
    const nlohmann::json document = parse_json(fmt::format(R"({{"image": {{"width": 24, "height": 24,
          "background": {{"bottom": [1, 1, 1], "top": [1, 1, 1]}}}},
        "camera": {{"position": [0.3, 0.6, 4.5], "target": [0, 0, 0], "fov": 30}},
        "render": {{"max_depth": 300, "samples": 16, "integrator": "path"}}, "media": {{"m": {}}},
        "materials": {{"m": {{"type": "dielectric", "medium": "m"}}, "mirror": {{"diffuse": 0, "ambient": 0, "reflection": 1}}}},
        "objects": [{{"type": "fractal", "formula": "mandelbulb", "material": "m"}} {}]}})",
                                                           medium, inside),
                                               "test.json");
    const JsonContext context{"test.json"};
    return read_scene(JsonValue(document, context));
  };
  const SceneDescription scattering = white(R"({"ior": 1.2, "scattering": [2, 2, 2]})", ""),
                         mirrors = white(R"({"absorption": [1e-6, 1e-6, 1e-6]})",
                                         R"(, {"type": "sphere", "radius": 0.6, "material": "mirror"})");
  on_picture_devices([&](const DeviceInfo& device) {
    for (const SceneDescription* scene : {&scattering, &mirrors}) {
      const RenderResult result = scenes::render_on(device, *scene);
      check_counts(result);
      double sum = 0;
      const auto channels = static_cast<std::size_t>(result.image.channels);
      for (std::size_t i = 0; i < result.image.data.size(); i += channels)
        sum += double(result.image.data[i]);
      CHECK(sum * double(channels) / double(result.image.data.size()) == Approx(1).epsilon(0.003));
    }
  });
}

TEST_CASE("glass and liquid in one place, or closer than a ray arrives, are one glass, in any order") {
  const std::string julia = R"("type": "fractal", "formula": "julia", "parameters": {"seed": [0, 0, 0, 0]})";
  const std::string smaller = julia + R"(, "transform": [{"scale": 0.999}])", nothing = ball(0.1, 9);
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* integrator : {"whitted", "path"}) {
      CAPTURE(integrator);
      const auto picture = [&](SceneDescription scene, bool swapped) {
        scene.render.integrator = integrator;
        if (swapped) std::swap(scene.objects[0], scene.objects[1]);
        const RenderResult result = scenes::render_on(device, scene);
        check_counts(result);
        return result.image;
      };
      const auto look_alike = [&](const std::string& one, const std::string& two, const auto& glass) {
        for (const bool swapped : {false, true}) {
          CAPTURE(one, two, swapped);
          const ImageDifference d = compare_images(picture(in_glass(one, two), swapped), glass, 0.02);
          CHECK(d.over_tolerance <= d.pixels / 100);
        }
      };
      look_alike(julia, julia, picture(in_glass(julia, nothing), false));
      look_alike(julia, smaller, picture(in_glass(julia, nothing), false));
      const std::string closed = formula("length(p) - 0.7");
      look_alike(closed, closed, picture(in_glass(ball(0.7, 0), ball(0.7, 0)), false));
    }
  });
}

TEST_CASE("a hollow field of glass holds a field of liquid that reaches into its wall") {
  const std::string vessel = formula("max(length(p) - 1, 0.9 - length(p))");
  on_picture_devices([&](const DeviceInfo& device) {
    check_counts(scenes::render_on(device, in_glass(vessel, formula("max(length(p) - 0.95, p.y - 0.1)"))));
    check_counts(scenes::render_on(
        device,
        in_glass(
            formula(
                "max(max(length(p.x, p.z) - 0.7, abs(p.y) - 0.9), min(0.6 - length(p.x, p.z), p.y + 0.8))"),
            formula("max(max(length(p.x, p.z) - 0.65, -0.85 - p.y), p.y - 0.2)"))));
  });
}

TEST_CASE("a fractal that a hidden surface cuts sends rays on from the right side of it") {
  SceneDescription scene = in_glass(R"("type": "box", "min": [-0.6, -0.8, -0.6], "max": [0.6, 0.7, 0.6])",
                                    R"("type": "box", "min": [-1, -1, -1], "max": [1, 0, 1])");
  const SceneDescription bulb =
      in_glass(R"("type": "fractal", "formula": "mandelbulb", "detail": 0.75, "transform": [{"scale": 0.4}])",
               ball(1, 9));
  scene.fields = bulb.fields;
  scene.objects.push_back(bulb.objects[0]);
  scene.objects.back().material = 0;
  scene.environment.type = EnvironmentType::gradient;
  scene.render.integrator = "path";
  scene.render.samples = 16;
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult result = scenes::render_on(device, scene);
    CHECK(result.counts[COUNT_MEDIA_STACK_OVERFLOW] == 0);
    CHECK(result.counts[COUNT_STRAY_EXIT] < 6);  // of a million: within rounding of the hidden surface
  });
}
