// Light near fields, in closed form beside a wall x = 0 and a floor: occlusion, soft shadows, glow and the
// colours of the orbit. The scenes share their kernels: all fields have one formula, and each has all of
// these, some without effect.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/image_compare.h"
#include "catch.h"
#include "devices.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"
#include "sdf_testing.h"

using namespace sundog;

namespace {

struct Wanted {
  double wall = 0, ground = -9;  // faces of the field at x = wall and at y = ground
  double occlusion = 1e-3;       // reach
  double soft_shadow = 1;        // hardness
  std::string glow = "[0, 0, 0]";
  std::string color_by = "radius", coloring = R"("palette": [[1, 1, 1]])";
  std::string transform;  // of the field
  std::string camera = R"("position": [0.25, 1.2, 0], "target": [0.25, 0, 0])";
  std::string lights = R"({"type": "ambient"})";
  std::string floor;  // a further object
};

SceneDescription scene_of(const Wanted& wanted) {
  const std::string text = fmt::format(
      R"x({{"image": {{"width": 1, "height": 1}}, "camera": {{{}, "up": [0, 0, 1], "fov": 1}},
    "lights": [{}], "materials": {{"white": {{"color": [1, 1, 1], "ambient": 1, "diffuse": 1}}}},
    "objects": [{{"type": "formula", "distance": "min(p.x - wall, p.y - ground)",
      "parameters": {{"wall": {}, "ground": {}}}, "material": "white", "occlusion": {}, "soft_shadow": {},
      "interval": {{"min": [-1.4, -1.4, -1.4], "max": [1.4, 1.4, 1.4]}},
      "glow": {{"color": {}, "width": 0.2}}, "coloring": {{"by": "{}", {}}}, "transform": [{}]}}{}]}})x",
      wanted.camera, wanted.lights, wanted.wall, wanted.ground, wanted.occlusion, wanted.soft_shadow,
      wanted.glow, wanted.color_by, wanted.coloring, wanted.transform, wanted.floor);
  const nlohmann::json document = parse_json(text, "test.json");
  const JsonContext context{"test.json"};
  return read_scene(JsonValue(document, context));
}

// A plane at y = 0, an exact solid; where a field is the floor it lies far below, so that the kernels are the
// same.
const std::string floor_below = R"(, {"type": "plane", "material": "white"})";

/// Checks that the picture about x = `at` is the same of fields that are put together and of the solids that
/// they are.
void check_same(const DeviceInfo& device, double at, const std::string& fields, const std::string& solids) {
  const auto picture = [&](const std::string& objects) {
    const std::string text = fmt::format(
        R"({{"image": {{"width": 24, "height": 24, "background": [0, 0, 1]}},
      "camera": {{"position": [{}, 2, 5], "target": [{}, 0, 0], "fov": 30}},
      "lights": [{{"type": "directional", "direction": [-1, -2, -3]}}],
      "materials": {{"white": {{"color": [1, 1, 1], "diffuse": 1}}}}, "objects": [{}]}})",
        at + 1, at, objects);
    const nlohmann::json document = parse_json(text, "test.json");
    const JsonContext context{"test.json"};
    return scenes::render_on(device, read_scene(JsonValue(document, context))).image;
  };
  const ImageDifference difference = compare_images(picture(fields), picture(solids), 0.02);
  CHECK(difference.over_tolerance < 12);  // of 576: outlines
}

/// Openness on the floor at the distance `a` from a wall: five points up to `reach` over the floor, whose
/// nearest surface is the floor or the wall.
double openness(double a, double reach) {
  double weight = 1, total = 0, missing = 0;
  for (int i = 1; i <= 5; ++i, weight *= 0.6) {
    const double h = reach * i / 5;
    missing += weight * std::max(1 - a / h, 0.0);
    total += weight;
  }
  return 1 - missing / total;
}

}  // namespace

TEST_CASE("ambient light in a corner is less by what the wall takes of five points up to the reach") {
  Wanted corner;
  corner.ground = 0;
  corner.floor = R"(, {"type": "plane", "material": "white", "point": [0, -9, 0]})";
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double reach : {0.2, 0.5, 0.7}) {
      corner.occlusion = reach;
      CHECK(scenes::pixel_on(device, scene_of(corner)).x == Approx(openness(0.25, reach)).epsilon(2e-3));
    }
  });
}

TEST_CASE("a wall's soft shadow is its distance over that of the farthest point of the way to the light") {
  // The march on from the floor takes steps of 0.25, the wall's distance, and the last one within the
  // interval is at 1.25.
  Wanted wall;
  wall.lights = R"({"type": "directional", "direction": [0, -1, 0]})";
  wall.floor = floor_below;
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double hardness : {1.0, 2.0, 9.0}) {
      wall.soft_shadow = hardness;
      CHECK(scenes::pixel_on(device, scene_of(wall)).x ==
            Approx(std::min(hardness * 0.25 / 1.25, 1.0)).epsilon(2e-3));
    }
    // A light within the interval ends the way; what is twice as large has the same shadow.
    Wanted near = wall;
    near.soft_shadow = 1;
    near.lights = R"({"type": "point", "position": [0.25, 0.6, 0]})";
    CHECK(scenes::pixel_on(device, scene_of(near)).x == Approx(0.25 / 0.5).epsilon(2e-3));
    Wanted large = wall;
    large.soft_shadow = 2;
    large.transform = R"({"scale": 2})";
    large.camera = R"("position": [0.5, 2.4, 0], "target": [0.5, 0, 0])";
    CHECK(scenes::pixel_on(device, scene_of(large)).x == Approx(2 * 0.25 / 1.25).epsilon(2e-3));
    large.soft_shadow = 1;
    large.lights = R"({"type": "point", "position": [0.5, 1.2, 0]})";
    CHECK(scenes::pixel_on(device, scene_of(large)).x == Approx(0.25 / 0.5).epsilon(2e-3));
  });
}

TEST_CASE("a ray that passes a glowing field gathers exp(-d / width) of its colour, d its least distance") {
  Wanted wall;
  wall.glow = "[0.5, 0.25, 1]";
  wall.lights = R"({"type": "ambient", "intensity": 0})";
  wall.floor = floor_below;
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double a : {0.1, 0.25}) {
      wall.camera = fmt::format(R"("position": [{0}, 1.2, 0], "target": [{0}, 0, 0])", a);
      const glm::dvec3 seen = scenes::pixel_on(device, scene_of(wall));
      CHECK(seen.x == Approx(0.5 * std::exp(-a / 0.2)).epsilon(2e-3));
      CHECK(seen.z == Approx(std::exp(-a / 0.2)).epsilon(2e-3));
    }
  });
}

TEST_CASE("a field's colour is the palette at its trap, blended between the stops and round to the first") {
  Wanted floor;
  floor.wall = -9, floor.ground = 0;
  floor.floor = R"(, {"type": "plane", "material": "white", "point": [0, -9, 0]})";
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double a : {0.25, 0.45}) {
      floor.camera = fmt::format(R"("position": [{0}, 1.2, 0], "target": [{0}, 0, 0])", a);
      floor.coloring = R"("palette": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "scale": 2, "offset": 0.05)";
      const double place = 3 * (2 * a + 0.05 - std::floor(2 * a + 0.05));  // 1.65, 2.85
      const double second = std::max(1 - std::abs(place - 1), 0.0), third = 1 - std::abs(place - 2);
      const glm::dvec3 seen = scenes::pixel_on(device, scene_of(floor));
      CHECK(seen.x == Approx(1 - second - third).margin(2e-3));
      CHECK(seen.y == Approx(second).margin(2e-3));
      CHECK(seen.z == Approx(third).margin(2e-3));
      floor.coloring = R"("palette": [[0.5, 0.25, 1]])";
      const glm::dvec3 alone = scenes::pixel_on(device, scene_of(floor));
      for (int c = 0; c < 3; ++c) CHECK(alone[c] == Approx(c == 2 ? 1 : 0.5 / (1 + c)).epsilon(1e-5));
    }
  });
}

TEST_CASE(
    "the trap of a closed form is its distance from the origin, the nearest plane or the nearest axis") {
  Wanted floor;
  floor.wall = -9, floor.ground = 0.3;
  floor.floor = R"(, {"type": "plane", "material": "white", "point": [0, -9, 0]})";
  floor.camera = R"("position": [0.45, 1.2, 0.2], "target": [0.45, 0.3, 0.2])";
  floor.coloring = R"("palette": [[0, 0, 0], [1, 1, 1]])";  // below a half, twice the trap
  const std::pair<const char*, double> traps[] = {
      {"point", std::hypot(0.45, 0.3, 0.2)}, {"plane", 0.2}, {"axis", std::hypot(0.3, 0.2)}};
  on_picture_devices([&](const DeviceInfo& device) {
    for (const auto& [by, trap] : traps) {
      floor.color_by = by;
      INFO(by);
      CHECK(scenes::pixel_on(device, scene_of(floor)).x == Approx(1 - std::abs(1 - 2 * trap)).margin(2e-3));
    }
  });
}

TEST_CASE("repeated, thickened and hollow fields have the sizes that they are given") {
  // Far apart in one scene, so that the fields are one program.
  constexpr double thick = 20, hollow = -20;
  const std::string ball = R"({"type": "formula", "distance": "length(p) - 0.4"})";
  const auto placed = [](double x) {
    return fmt::format(
        R"("interval": {{"min": [-3, -3, -3], "max": [3, 3, 3]}}, "material": "white",
          "transform": [{{"translate": [{}, 0, 0]}}])",
        x);
  };
  const std::string fields = fmt::format(
      R"({{"type": "repeat", "field": {0}, "period": [1, 0, 0], "count": [1, 0, 0], {1}}},
      {{"type": "thicken", "field": {0}, "amount": 0.3, {2}}}, {{"type": "shell", "field": {0}, "amount": 0.3, {3}}})",
      ball, placed(0), placed(thick), placed(hollow));
  const auto sphere = [](double x, double radius) {
    return fmt::format(R"({{"type": "sphere", "center": [{}, 0, 0], "radius": {}, "material": "white"}})", x,
                       radius);
  };
  on_picture_devices([&](const DeviceInfo& device) {
    if (!is_quick(device)) return;
    check_same(device, 0, fields, sphere(-1, 0.4) + ", " + sphere(0, 0.4) + ", " + sphere(1, 0.4));
    check_same(device, thick, fields, sphere(thick, 0.7));
    check_same(device, hollow, fields, sphere(hollow, 0.55));
  });
}
