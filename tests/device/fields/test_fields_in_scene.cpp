// Distance fields as objects of a scene: closed forms, and the same pictures as exact solids make.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/image_compare.h"
#include "catch.h"
#include "devices.h"
#include "same_bits.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"
#include "sdf_testing.h"

using namespace sundog;

namespace {

SceneDescription scene_of_text(const std::string& text) {
  const nlohmann::json document = parse_json(text, "test.json");
  const JsonContext context{"test.json"};
  return read_scene(JsonValue(document, context));
}

/// A small scene with a table, a box and three materials around `object`.
SceneDescription still_life(const std::string& object) {
  return scene_of_text(R"({"image": {"width": 96, "height": 96,
      "background": {"bottom": [0.3, 0.35, 0.4], "top": [0.6, 0.75, 0.95]}},
    "camera": {"position": [0.6, 1.0, 3.4], "target": [0, 0, 0], "fov": 40},
    "lights": [{"type": "ambient", "intensity": 0.4}, {"type": "point", "position": [3, 5, 2]}],
    "materials": {"glass": {"type": "dielectric", "ior": 1.5, "specular": 0.3},
      "mirror": {"color": [0.1, 0.1, 0.1], "reflection": 0.8}, "matte": {"color": [0.8, 0.5, 0.3]},
      "floor": {"color": {"checker": [[0.1, 0.1, 0.1], [0.7, 0.7, 0.7]]}}},
    "objects": [{"type": "plane", "point": [0, -1.2, 0], "material": "floor"},
      {"type": "box", "half": [0.3, 0.3, 0.3], "center": [-1.3, -0.9, 0.2], "material": "matte"}, )" +
                       object + "]}");
}

/// A glass ball of radius 1 about the origin with ior 1 that absorbs red, as a field in the given interval,
/// and a white glow behind it.
SceneDescription absorbing_ball(const std::string& interval) {
  return scene_of_text(fmt::format(R"({{"image": {{"width": 1, "height": 1, "background": [1, 1, 1]}},
    "camera": {{"position": [0, 0, 5], "target": [0, 0, 0], "fov": 0.001}},
    "media": {{"ink": {{"ior": 1, "absorption": [0.7, 0, 0]}}}},
    "materials": {{"ink": {{"type": "dielectric", "medium": "ink"}}}},
    "objects": [{{"type": "formula", "distance": "length(p) - 1", "interval": {}, "material": "ink"}}]}})",
                                   interval));
}

}  // namespace

TEST_CASE("distance fields look like exact solids") {
  struct Pair {
    const char *solid, *field;
  };
  constexpr std::array pairs = {
      Pair{
          R"("type": "sphere", "radius": 0.5, "center": [-0.9, 0.4, 0])",
          R"("type": "formula", "distance": "length(p) - 0.5", "transform": [{"translate": [-0.9, 0.4, 0]}])"},
      Pair{R"("type": "torus", "major_radius": 0.5, "minor_radius": 0.2,
              "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 40}}, {"translate": [0.4, -0.3, 0.5]}])",
           R"("type": "formula", "distance": "length(vec3(length(vec3(p.x, 0, p.z)) - 0.5, p.y, 0)) - 0.2",
              "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 40}}, {"translate": [0.4, -0.3, 0.5]}])"},
      Pair{R"("type": "box", "half": [0.4, 0.3, 0.3], "center": [0.6, 0.6, -0.4])",  // all of it the
                                                                                     // interval's cut
           R"("type": "formula", "distance": "length(p) - 5", "transform": [{"translate": [0.6, 0.6, -0.4]}],
              "interval": {"min": [-0.4, -0.3, -0.3], "max": [0.4, 0.3, 0.3]})"}};
  constexpr std::array materials = {"matte", "mirror", "glass"};
  // Each shape of each material, in three scenes that share their kernels.
  const std::size_t turn = GENERATE(0u, 1u, 2u);
  const auto scene = [&](const char* Pair::* kind) {
    std::string objects;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      objects += fmt::format(R"({}{{{}, "material": "{}"}})", i ? ", " : "", pairs[i].*kind,
                             materials[(i + turn) % materials.size()]);
    return still_life(objects);
  };
  const DeviceInfo& device = test_devices().front();
  const RenderResult solid = scenes::render_on(device, scene(&Pair::solid));
  const RenderResult field = scenes::render_on(device, scene(&Pair::field));
  const ImageDifference difference = compare_images(solid.image, field.image, 0.02);
  INFO("turn " << turn);
  CHECK(field.counts[COUNT_MARCH_STEPS] > 6000);
  CHECK(field.counts[COUNT_MARCH_LIMIT] < 150);
  CHECK(field.counts[COUNT_SHADOW_LIMIT] == 0);
  CHECK(difference.mean < 1e-3);
  CHECK(difference.over_tolerance < 100);  // of 9216: silhouettes
}

TEST_CASE("a closed form without thickness is lit as a thin one") {
  const auto wall = [](const char* formula, const char* size, double thickness) {
    return still_life(fmt::format(
        R"({{"type": "fractal", "formula": "{}", "material": "matte", "parameters": {{"{}": {}}}}})", formula,
        size, thickness));
  };
  on_picture_devices([&](const DeviceInfo& device) {
    for (const auto& [formula, size] : {std::pair{"gyroid", "thickness"}, {"cylinder", "half_height"}}) {
      CAPTURE(formula);
      const Image thin = scenes::render_on(device, wall(formula, size, 0.002)).image;
      const ImageDifference d =
          compare_images(scenes::render_on(device, wall(formula, size, 0)).image, thin, 0.1);
      CHECK(d.over_tolerance < d.pixels / 30);  // silhouettes
    }
  });
}

TEST_CASE("light through a field is absorbed over the length inside, as far as the interval reaches") {
  struct Cut {
    std::string interval;
    double length;
  };
  const Cut cut = GENERATE(Cut{R"({"min": [-2, -2, -2], "max": [2, 2, 2]})", 2},
                           Cut{R"({"min": [-2, -2, -0.25], "max": [2, 2, 2]})", 1.25},
                           Cut{R"({"min": [-2, -2, -0.25], "max": [2, 2, 0.5]})", 0.75});
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label() << cut.length) {
      const glm::dvec3 seen = scenes::pixel_on(device, absorbing_ball(cut.interval));
      CHECK(seen.x == Approx(std::exp(-0.7 * cut.length)).epsilon(2e-4));
      CHECK(seen.y == 1);  // nothing is lost at interfaces between equal indices
    }
}

TEST_CASE("light through a wall of a field meets the wall behind it, too") {
  const auto ball = [](const std::string& shape, const char* material) {
    return scene_of_text(fmt::format(R"({{"image": {{"width": 1, "height": 1, "background": [1, 1, 1]}},
      "camera": {{"position": [0, 0, 5], "target": [0, 0, 0], "fov": 0.001}},
      "materials": {{"half": {{"ambient": 0, "diffuse": 0, {}}}}}, "objects": [{{{}, "material": "half"}}]}})",
                                     material, shape));
  };
  for (const DeviceInfo& device : picture_devices())
    for (const char* shape :
         {R"("type": "formula", "distance": "length(p) - 1")",
          R"x("type": "formula", "distance": "abs(p.z)")x",  // without thickness
          R"("type": "fractal", "formula": "julia", "parameters": {"seed": [0, 0, 0, 0]})"})
      for (const char* material : {R"("transmission": 0.5)", R"("opacity": 0.5)"}) {
        CAPTURE(shape, material);
        CHECK(scenes::pixel_on(device, ball(shape, material)).x == Approx(0.25));
      }
}

TEST_CASE("a glass fractal refracts as its exact solid does, and one of the air's own index cannot be seen") {
  const auto with = [](const std::string& object, double ior) {
    return scene_of_text(fmt::format(R"({{"image": {{"width": 96, "height": 96,
        "background": {{"bottom": [0.55, 0.6, 0.66], "top": [0.16, 0.3, 0.55]}}}}, "render": {{"max_depth": 12}},
      "camera": {{"position": [1.3, 1.5, 3.6], "target": [0, 0, 0], "fov": 40}},
      "materials": {{"glass": {{"type": "dielectric", "ior": {}}}}}, "objects": [{}]}})",
                                     ior, object));
  };
  const std::string julia = R"({"type": "fractal", "formula": "julia", "material": "glass", "iterations": )";
  const std::string ball =
      julia + R"(24, "parameters": {"seed": [0, 0, 0, 0]}})";  // the unit ball's boundary
  const std::string folds = julia + R"(6, "parameters": {"seed": [-0.2, 0.6, 0.2, 0.2]}})";
  on_picture_devices([&](const DeviceInfo& device) {
    if (!is_quick(device)) return;
    const RenderResult exact =
        scenes::render_on(device, with(R"({"type": "sphere", "material": "glass"})", 1.5));
    const RenderResult marched = scenes::render_on(device, with(ball, 1.5));
    const ImageDifference difference = compare_images(exact.image, marched.image, 0.1);
    CHECK(difference.mean < 3e-3);
    CHECK(difference.over_tolerance < 60);  // of 9216: the outline, where all light comes from a thin rim
    CHECK(marched.counts[COUNT_MARCH_LIMIT] == 0);
    // Hardly refracting, what enters comes out again, but for cracks that are narrower than a pixel.
    const RenderResult empty = scenes::render_on(device, with(R"({"type": "sphere", "radius": 1e-3,
          "center": [9, 9, 9], "material": "glass"})",
                                                              1));
    const RenderResult hardly = scenes::render_on(device, with(folds, 1.0001));
    CHECK(hardly.counts[COUNT_PRIMARY_HIT] > 3000);
    CHECK(compare_images(empty.image, hardly.image, 0.02).over_tolerance < 100);
    CHECK(same_bits(empty.image, scenes::render_on(device, with(folds, 1)).image));
  });
}

TEST_CASE("a camera inside a field sees out through the rest of its medium") {
  SceneDescription scene = absorbing_ball(R"({"min": [-2, -2, -2], "max": [2, 2, 2]})");
  scene.camera.position = {0, 0, 0.5};
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(scenes::pixel_on(device, scene).x == Approx(std::exp(-0.7 * 1.5)).epsilon(2e-4));
  });
}

TEST_CASE("fields and solids shadow each other") {
  const auto scene = [](const std::string& above, const std::string& below) {
    return scene_of_text(R"({"image": {"width": 1, "height": 1},
      "camera": {"position": [0, 0.5, 5], "target": [0, -0.9999, 0], "fov": 0.001},
      "lights": [{"type": "directional", "direction": [0, -1, 0]}],
      "materials": {"m": {"color": [1, 1, 1], "diffuse": 1, "ambient": 0}},
      "objects": [)" + above +
                         ", " + below + "]}");
  };
  const auto placed = [](const char* what, double y) {
    return fmt::format(R"({{{}, "material": "m", "transform": [{{"translate": [0, {}, 0]}}]}})", what, y);
  };
  const auto field = [&](double y) { return placed(R"("type": "formula", "distance": "length(p) - 1")", y); };
  const auto ball = [&](double y) { return placed(R"("type": "sphere", "radius": 1)", y); };
  const auto floor = [](double y) {
    return fmt::format(R"({{"type": "plane", "point": [0, {}, 0], "material": "m"}})", y);
  };
  // Every case holds every solid, the unneeded ones out of the way: all share one kernel.
  const auto seen = [&](double upper_field, double lower_field, double sphere, double plane) {
    const std::string fields = field(upper_field) + ", " + field(lower_field);
    return scenes::pixel_on(test_devices().front(), scene(fields, ball(sphere) + ", " + floor(plane))).x;
  };
  CHECK(seen(3, -9, -19, -1) == 0);
  CHECK(seen(-9, -2, 3, -99) == 0);
  CHECK(seen(3, -2, -19, -99) == 0);
  CHECK(seen(-5, -9, -19, -1) == Approx(1).epsilon(1e-5));
  // The top of the ball, seen slantwise: lit by the cosine of its slope there.
  CHECK(seen(-9, -2, -19, -99) > 0.99);
}

TEST_CASE("a ray in a mirror or behind a pane is as wide as its way is long") {
  // The unit ball as a Julia set, in a pixel so wide that rays stop far before it: its colour tells where.
  // The pane's other ray goes a longer way, to a slanting mirror and up.
  const auto scene = [](const std::string& camera, const std::string& pane, int far) {
    return scene_of_text(fmt::format(
        R"({{"image": {{"width": 1, "height": 1}}, "camera": {{{}, "fov": 0.3}}, "lights": [{{"type": "ambient"}}],
      "materials": {{"m": {{"color": [1, 1, 1], "ambient": 1}}, "mirror": {{"color": [0, 0, 0], "reflection": 1}},
        "pane": {{"color": [0, 0, 0], {}}}}},
      "objects": [{{"type": "fractal", "formula": "julia", "parameters": {{"seed": [0, 0, 0, 0]}}, "material": "m",
        "coloring": {{"by": "radius", "palette": [[0, 0, 0], [1, 1, 1]], "scale": 2, "offset": -2}}}},
        {{"type": "disk", "radius": 3, "material": "pane", "transform": [{{"rotate": {{"axis": [1, 0, 0], "degrees": 90}}}},
          {{"translate": [0, 0, 6]}}]}},
        {{"type": "plane", "material": "mirror", "normal": [0, 1, -1], "point": [0, 0, {}]}}]}})",
        camera, pane, far));
  };
  const std::string to_pane = R"("position": [0, 0, 3], "target": [0, 0, 4])",
                    to_ball = R"("position": [0, 0, 9], "target": [0, 0, 0])",
                    half = R"("reflection": 0.5, "transmission": 0.5)";
  on_picture_devices([&](const DeviceInfo& device) {
    const double direct = scenes::pixel_on(device, scene(to_ball, R"("transmission": 1)", 50)).x;
    CHECK(direct > 0.1);
    CHECK(scenes::pixel_on(device, scene(to_ball, half, 50)).x == Approx(direct / 2).epsilon(0.05));
    CHECK(scenes::pixel_on(device, scene(to_pane, half, 50)).x == Approx(direct / 2).epsilon(0.05));
  });
}

TEST_CASE("a named field placed twice is two of them") {
  const std::string head =
      R"({"fields": {"ball": {"field": {"type": "formula", "distance": "length(p) - 0.5"},
    "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}}},)";
  const auto scene = [&](const std::string& fields, const std::string& one, const std::string& two) {
    return scene_of_text(fields + R"("image": {"width": 64, "height": 48},
      "camera": {"position": [0, 1, 5], "target": [0, 0, 0]},
      "lights": [{"type": "directional", "direction": [-1, -1, -0.3]}],
      "materials": {"m": {"color": [1, 1, 1]}}, "objects": [)" +
                         fmt::format(R"({{{}, "material": "m", "transform": [{{"translate": [-0.8, 0, 0]}}]}},
        {{{}, "material": "m", "transform": [{{"scale": [1.5, 1, 1]}}, {{"translate": [0.8, 0, 0]}}]}}]}})",
                                     one, two));
  };
  const std::string field = R"("type": "field", "field": "ball")",
                    solid = R"("type": "sphere", "radius": 0.5)";
  on_picture_devices([&](const DeviceInfo& device) {
    const Image fields = scenes::render_on(device, scene(head, field, field)).image;
    const Image solids = scenes::render_on(device, scene("{", solid, solid)).image;
    CHECK(compare_images(solids, fields, 0.02).over_tolerance < 20);
  });
}

TEST_CASE("a scene with fields has the same bits for every work-group and tile size") {
  const SceneDescription scene = still_life(
      R"({"type": "fractal", "formula": "julia", "material": "glass", "occlusion": 0.1, "soft_shadow": 8,
          "glow": {"color": [0.1, 0.2, 0.3]}},
         {"type": "fractal", "formula": "menger", "material": "mirror", "transform": [{"scale": 0.3},
          {"translate": [0.9, -0.8, 0.9]}]})");
  on_picture_devices([&](const DeviceInfo& device) {
    if (!is_quick(device)) return;  // two minutes of Mesa's compiler
    const RenderResult reference = scenes::render_on(device, scene);
    REQUIRE(reference.counts[COUNT_REFRACTION] > 0);
    for (const std::size_t group : {std::size_t{1}, std::size_t{5}, std::size_t{16}}) {
      RenderOptions options;
      options.work_group = {WorkGroup::Kind::fixed, group, 1};
      options.tile = group == 5 ? 12 : 40;
      CHECK(same_bits(scenes::render_on(device, scene, options).image, reference.image));
    }
  });
}

TEST_CASE("every kind of solid stands beside a field") {
  const SceneDescription scene = scene_of_text(R"({"image": {"width": 32, "height": 32},
    "camera": {"position": [0, 0, 9], "target": [0, 0, 0], "fov": 50},
    "materials": {"white": {"color": [0.8, 0.8, 0.8], "ambient": 1}},
    "lights": [{"type": "ambient"}],
    "objects": [{"type": "formula", "distance": "length(p) - 1", "material": "white"},
      {"type": "sphere", "center": [3, 0, 0], "material": "white"},
      {"type": "box", "center": [-3, 0, 0], "half": [1, 1, 1], "material": "white"},
      {"type": "cylinder", "material": "white", "transform": [{"translate": [0, 3, 0]}]},
      {"type": "cone", "material": "white", "transform": [{"translate": [0, -3, 0]}]},
      {"type": "disk", "material": "white", "transform": [{"translate": [3, 3, 0]}]},
      {"type": "torus", "material": "white", "transform": [{"translate": [-3, 3, 0]}]},
      {"type": "round_box", "material": "white", "transform": [{"translate": [3, -3, 0]}]}]})");
  on_picture_devices([&](const DeviceInfo& device) {
    const Image image = scenes::render_on(device, scene).image;
    CHECK(*std::max_element(image.data.begin(), image.data.end()) > 0.3f);
  });
}

TEST_CASE("paths through a field of glass lose what its medium absorbs and nothing else") {
  const DeviceInfo device = test_devices().front();
  SceneDescription ink = absorbing_ball(R"({"min": [-2, -2, -2], "max": [2, 2, 2]})");
  ink.render.integrator = "path";
  ink.render.samples = 4;
  const glm::dvec3 seen = scenes::pixel_on(device, ink);
  CHECK(seen.x == Approx(std::exp(-1.4)).epsilon(1e-3));
  CHECK(seen.y == Approx(1));
  // In a white furnace clear glass cannot be seen; the mean does not depend on roulette.
  for (const int roulette : {2, 65}) {
    SceneDescription glass = absorbing_ball(R"({"min": [-2, -2, -2], "max": [2, 2, 2]})");
    glass.render.integrator = "path";
    glass.render.roulette = roulette;
    glass.render.samples = 64;
    glass.render.max_depth = 64;
    glass.image.width = glass.image.height = 8;
    glass.camera.fov = 15;
    glass.media.back().absorption = dvec3(0);
    glass.media.back().ior = 1.5;
    const Image image = scenes::render_on(device, glass).image;
    double sum = 0;
    for (std::size_t i = 0; i < image.data.size(); i += 4) sum += static_cast<double>(image.data[i]);
    INFO("roulette from ray " << roulette);
    CHECK(sum / 64 == Approx(1).epsilon(0.01));
  }
}

TEST_CASE("paths find a lamp through a ball of glass as a field as through the exact one") {
  const auto below = [](const std::string& ball) {
    return scene_of_text(
        R"({"image": {"width": 16, "height": 16}, "render": {"integrator": "path", "samples": 128},
      "camera": {"position": [0, 1.2, 3.5], "target": [0, -1, 0], "fov": 14},
      "lights": [{"type": "sphere", "position": [0, 3, 0], "radius": 0.6, "intensity": 4}],
      "materials": {"glass": {"type": "dielectric", "ior": 1.5}, "floor": {"diffuse": 0.8}},
      "objects": [{"type": "plane", "point": [0, -1, 0], "material": "floor"}, {"material": "glass", )" +
        ball + "}]}");
  };
  const DeviceInfo device = test_devices().front();
  const Image solid = scenes::render_on(device, below(R"("type": "sphere", "radius": 0.6)")).image;
  const Image field =
      scenes::render_on(device, below(R"("type": "formula", "distance": "length(p) - 0.6")")).image;
  double sum = 0, squares = 0, all = 0;
  for (std::size_t i = 0; i < solid.data.size(); i += 4) {
    const double off = static_cast<double>(field.data[i]) - static_cast<double>(solid.data[i]);
    sum += off;
    squares += off * off;
    all += static_cast<double>(solid.data[i]);
  }
  const double count = double(solid.data.size()) / 4, mean = sum / count;
  const double error = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
  INFO(mean << " +- " << error << " of " << all / count);
  CHECK(all / count > 0.05);
  CHECK(std::abs(mean) < 3 * error + 2e-3 * all / count);
}
