// Photons on layered and glossy surfaces, of glass that moves, and where planes stand in their way: they
// bring the light that paths find by chance, and no other. Lamps' light on every local lobe.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "compile/compiled_scene.h"
#include "path_testing.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "shared/lobes.h"

using namespace sundog;
using namespace sundog::paths;

namespace {

SceneDescription scene_of(const std::string& text) {
  const nlohmann::json document = parse_json(text, "test.json");
  const JsonContext context{"test.json"};
  return read_scene(JsonValue(document, context));
}

constexpr const char* ball_lamp =
    R"({"type": "sphere", "position": [0, 5, -5], "radius": 1.5, "intensity": 8})";
constexpr const char* small_spot =
    R"({"type": "spot", "position": [0, 5, -5], "target": [0, 0.5, 0], "outer_angle": 30, "intensity": 2})";

constexpr const char *glass = R"({"type": "dielectric", "ior": 1.5})",
                     *white = R"({"color": [0.7, 0.7, 0.7], "diffuse": 1, "ambient": 0})";

/// The light of a lamp behind a ball on a floor.
SceneDescription floor_behind_ball(const std::string& lamp, const std::string& floor,
                                   const std::string& ball = glass) {
  return scene_of(fmt::format(
      R"({{"camera": {{"position": [0, 4, 5], "target": [0, 0, 1.1], "fov": 7}},
      "image": {{"width": 16, "height": 16}},
      "render": {{"integrator": "path", "caustics": true, "samples": 64, "max_depth": 8}},
      "lights": [{}],
      "materials": {{"floor": {}, "ball": {}}},
      "objects": [{{"type": "box", "min": [-5, -0.4, -5], "max": [5, 0, 5], "material": "floor"}},
        {{"type": "sphere", "center": [0, 0.9, 0], "radius": 0.85, "material": "ball"}}]}})",
      lamp, floor, ball));
}

/// The materials of a ball that sends photons on, and of the floor that receives them.
struct BallOnFloor {
  const char *ball = glass, *floor = white;
};

/// A ball or a floor with a single lobe, for each row of kernels/shared/lobes.h.
constexpr BallOnFloor with_refraction{}, with_diffuse{};
constexpr BallOnFloor with_mirror{.ball = R"({"color": [0, 0, 0], "reflection": 0.9})"};
constexpr BallOnFloor with_ggx{.floor = R"({"color": [0, 0, 0], "reflection": 0.8, "roughness": 0.6})"};
constexpr BallOnFloor with_layered{
    .floor = R"({"type": "openpbr", "base_color": [0.4, 0.4, 0.4], "specular_roughness": 0.42})"};
constexpr BallOnFloor with_highlight{
    .floor = R"({"color": [0, 0, 0], "specular": {"color": [0.6, 0.6, 0.6], "exponent": 6}})"};
#define WITH_LOBE(feature, name, flags) with_##name,
constexpr BallOnFloor with_every_lobe[] = {PERFECT_LOBES(WITH_LOBE) SCATTERING_LOBES(WITH_LOBE)};
constexpr BallOnFloor with_every_local_lobe[] = {LOCAL_LOBES(WITH_LOBE)};
#undef WITH_LOBE

double greatest_over_mean(const Image& image) {
  double most = 0, sum = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4) {
    most = std::max(most, double(image.data[i]));
    sum += double(image.data[i]);
  }
  return most * double(image.data.size()) / 4 / sum;
}

/// A ball of glass under a lamp, seen from above; it moves, or stands where it is at the time.
SceneDescription moving_ball(std::optional<double> time) {
  const double at = time.value_or(0), way = time ? 0 : 1;
  return scene_of(fmt::format(
      R"({{"camera": {{"position": [0, 6, 0.01], "target": [0.3, 0, 0.1], "up": [0, 0, -1], "fov": 20}},
      "image": {{"width": 16, "height": 16}},
      "render": {{"integrator": "path", "caustics": true, "samples": 32, "max_depth": 12}},
      "lights": [{{"type": "sphere", "position": [1, 3, 1], "radius": 0.35, "intensity": 20}}],
      "materials": {{"white": {{"color": [0.7, 0.7, 0.7], "ambient": 0, "diffuse": 1}},
        "glass": {{"type": "dielectric", "ior": 1.5}}}},
      "objects": [{{"type": "plane", "material": "white"}},
        {{"type": "sphere", "radius": 0.6, "center": [{}, 0.8, {}], "material": "glass", "moves_by": [{}, 0, {}]}}]}})",
      0.8 * at, 0.3 * at, 0.8 * way, 0.3 * way));
}

/// The light of a lamp behind a ball of glass on a fractal, seen from aside.
SceneDescription fractal_behind_ball(const std::string& formula) {
  return scene_of(fmt::format(
      R"({{"camera": {{"position": [0, 4, -5], "target": [0, 0.9, 0], "fov": 12}},
      "image": {{"width": 32, "height": 32}},
      "render": {{"integrator": "path", "caustics": true, "samples": 32, "max_depth": 5,
        "path": {{"photon_radius": 0.03}}}},
      "lights": [{{"type": "sphere", "position": [0, 6, 0], "radius": 1.2, "intensity": 60}}],
      "materials": {{"white": {{"color": [0.8, 0.8, 0.8], "diffuse": 1}},
        "glass": {{"type": "dielectric", "ior": 1.5}}}},
      "objects": [{{"type": "fractal", "formula": "{}", "material": "white"}},
        {{"type": "sphere", "radius": 0.6, "center": [0, 2.2, 0], "material": "glass"}}]}})",
      formula));
}

/// A plate below a ball of glass; it moves, or stands as it does at the time.
SceneDescription plate(const std::string& motion) {
  return scene_of(fmt::format(
      R"({{"camera": {{"position": [0, 3, 4], "target": [0, 0.4, 0], "fov": 12}},
      "image": {{"width": 16, "height": 16}},
      "render": {{"integrator": "path", "caustics": true, "samples": 64, "max_depth": 6}},
      "lights": [{{"type": "point", "position": [0, 6, 0.01], "intensity": 40,
        "falloff": {{"constant": 0, "quadratic": 1}}}}],
      "materials": {{"white": {{"color": [0.8, 0.8, 0.8], "diffuse": 1}},
        "glass": {{"type": "dielectric", "ior": 1.5}}}},
      "objects": [{{"type": "group", "objects": [{{"type": "box", "half": [2, 0.1, 2], "material": "white"}}], {}}},
        {{"type": "sphere", "radius": 0.5, "center": [0, 1.4, 0], "material": "glass"}}]}})",
      motion));
}

/// A motion, and the transform that leads up to a part of it.
struct Motion {
  const char *moving, *name;
  std::string still(double part) const {
    if (name == std::string_view("translate"))
      return fmt::format(R"("transform": [{{"translate": [0, {}, 0]}}])", 0.5 * part);
    if (name == std::string_view("scale")) return fmt::format(R"("transform": [{{"scale": {}}}])", 1 + part);
    return fmt::format(R"("transform": [{{"rotate": {{"axis": [0, 0, 1], "degrees": {}}}}}])", 20 * part);
  }
};

}  // namespace

TEST_CASE("Whitted's integrator gives every local lobe the light of a lamp that paths give it") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const BallOnFloor& with : with_every_local_lobe) {
      SceneDescription scene = floor_behind_ball(small_spot, with.floor);
      scene.objects.pop_back();
      scene.render.caustics = false;
      scene.render.max_depth = 1;
      const Mean along_paths = mean_on(device, scene);
      scene.render.integrator = "whitted";
      const Mean classic = mean_on(device, scene);
      CAPTURE(with.floor, classic.value.x, along_paths.value.x);
      CHECK(classic.value.x > 0.01);
      CHECK(classic.value.x == Approx(along_paths.value.x).epsilon(1e-3));
    }
  });
}

TEST_CASE("photons that every perfect lobe sends on bring to every scattering one what paths find") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const BallOnFloor& with : with_every_lobe) {
      SceneDescription scene = floor_behind_ball(ball_lamp, with.floor, with.ball);
      const Mean brought = mean_on(device, scene);
      scene.render.caustics = false;
      scene.render.samples = 256;
      const Mean met = mean_on(device, scene);
      CAPTURE(with.floor, with.ball, brought.value.x, met.value.x);
      CHECK(brought.value.x == Approx(met.value.x).epsilon(0.04));
      CHECK(met.value.x > 0);
    }
  });
}

TEST_CASE("layered and glossy surfaces have from photons, and narrow lobes from paths, what paths find") {
  const char* floors[] = {
      R"({"type": "openpbr", "base_color": [0.4, 0.4, 0.4], "coat_weight": 1, "coat_roughness": 0.2})",
      R"({"type": "openpbr", "base_color": [0.8, 0.8, 0.8], "base_metalness": 1, "specular_roughness": 0.1})",
      R"({"type": "openpbr", "base_color": [0.8, 0.8, 0.8], "base_metalness": 1, "specular_roughness": 0.3})",
      R"({"type": "openpbr", "base_color": [0.8, 0.8, 0.8], "base_metalness": 1, "specular_roughness": 0.5})",
      R"({"color": [0.2, 0.2, 0.2], "diffuse": 1, "reflection": 0.3, "roughness": 0.3})",
      R"({"color": [0.2, 0.2, 0.2], "diffuse": 1, "specular": {"color": [0.3, 0.3, 0.3], "exponent": 400}})"};
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* floor : floors) {
      SceneDescription scene = floor_behind_ball(ball_lamp, floor);
      const Mean brought = mean_on(device, scene);
      scene.render.caustics = false;
      scene.render.samples = 256;
      const Mean met = mean_on(device, scene);
      CAPTURE(floor, brought.value.x, met.value.x);
      CHECK(brought.value.x == Approx(met.value.x).epsilon(0.04));
    }
  });
}

TEST_CASE("photons bring to rough fractals what paths find") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* formula : {"mandelbulb", "menger"}) {
      SceneDescription scene = fractal_behind_ball(formula);
      const Mean brought = mean_on(device, scene);
      scene.render.caustics = false;
      scene.render.samples = 512;
      const Mean met = mean_on(device, scene);
      CAPTURE(formula, brought.value.x, met.value.x);
      CHECK(brought.value.x == Approx(met.value.x).epsilon(0.05));
    }
  });
}

TEST_CASE("photons leave no specks on a glossy floor") {
  const auto speckled = [](const DeviceInfo& device, double reflection) {
    SceneDescription scene = floor_behind_ball(
        small_spot,
        fmt::format(R"({{"color": [0.2, 0.2, 0.2], "diffuse": 1, "reflection": {}, "roughness": 0.2}})",
                    reflection));
    scene.camera.fov = 18;
    scene.render.samples = 16;
    return greatest_over_mean(scenes::render_on(device, scene).image);
  };
  on_picture_devices(
      [&](const DeviceInfo& device) { CHECK(speckled(device, 0.3) < 1.02 * speckled(device, 0)); });
}

TEST_CASE("photons of moving glass make the mean of its stills") {
  on_picture_devices([&](const DeviceInfo& device) {
    constexpr int stills = 8;
    double sum = 0;
    for (int i = 0; i < stills; ++i) sum += mean_on(device, moving_ball((i + 0.5) / stills)).value.x;
    constexpr u32 seeds = 4;  // one picture has a noise of 7 %: its photons are cut into slices of time
    double moving = 0;
    for (u32 seed = 0; seed < seeds; ++seed) {
      SceneDescription scene = moving_ball({});
      scene.render.seed = seed;
      moving += mean_on(device, scene).value.x;
    }
    CHECK(moving / seeds == Approx(sum / stills).epsilon(0.08));
  });
}

TEST_CASE("photons on what moves make the mean of its stills") {
  constexpr Motion motions[] = {
      {R"("moves_by": [0, 0.5, 0])", "translate"},
      {R"("turns_by": {"axis": [0, 0, 1], "degrees": 20, "about": [0, 0, 0]})", "rotate"},
      {R"("grows_to": 2)", "scale"}};
  on_picture_devices([&](const DeviceInfo& device) {
    for (const Motion& motion : motions) {
      constexpr int stills = 8;
      double sum = 0, moving = 0;
      for (int i = 0; i < stills; ++i)
        sum += mean_on(device, plate(motion.still((i + 0.5) / stills))).value.x / stills;
      constexpr u32 seeds = 4;  // one picture has a noise of 3 %
      for (u32 seed = 0; seed < seeds; ++seed) {
        SceneDescription scene = plate(motion.moving);
        scene.render.seed = static_cast<int>(seed);
        moving += mean_on(device, scene).value.x / seeds;
      }
      CAPTURE(motion.name);
      CHECK(moving == Approx(sum).epsilon(0.04));
    }
  });
}

TEST_CASE("a plane without end between the sun and everything stops photons, as a box does") {
  const auto behind = [](const std::string& wall, const std::string& more) {
    return scene_of(fmt::format(
        R"({{"camera": {{"position": [0, 3, 7], "target": [0, 0, 1], "fov": 20}},
        "image": {{"width": 16, "height": 16}},
        "render": {{"integrator": "path", "caustics": true, "samples": 4}},
        "lights": [{{"type": "directional", "direction": [0.3, -0.6, 0.7], "intensity": 2{}}}],
        "materials": {{"white": {{"color": [0.8, 0.8, 0.8], "diffuse": 1, "ambient": 0}},
          "glass": {{"type": "dielectric", "ior": 1.5}}}},
        "objects": [{{"type": "plane", "material": "white"}}, {},
          {{"type": "sphere", "center": [0, 1, 0], "radius": 0.9, "material": "glass"}}]}})",
        more, wall));
  };
  const std::string
      opaque = R"({"type": "plane", "point": [0, 0, -12], "normal": [0, 0, 1], "material": "white"})",
      box = R"({"type": "box", "min": [-99, -1, -13], "max": [99, 99, -12], "material": "white"})",
      moving = R"({"type": "plane", "point": [0, 0, -12], "normal": [0, 0, 1], "material": "white",
                      "moves_by": [0, 0, -3]})";
  on_picture_devices([&](const DeviceInfo& device) {
    for (const std::string& sun : {std::string(), std::string(R"(, "angle": 2)")})
      for (const std::string& wall : {opaque, box, moving}) {
        CAPTURE(sun, wall);
        SceneDescription scene = behind(wall, sun);
        const double brought = mean_on(device, scene).value.x;
        scene.render.caustics = false;  // the ground far beyond a box is lit, and seen in the glass
        CHECK(brought == Approx(mean_on(device, scene).value.x).epsilon(0.05));
      }
    const std::string beyond =
        R"({"type": "plane", "point": [0, 0, 9], "normal": [0, 0, -1], "material": "white"})";
    SceneDescription scene = behind(beyond, "");
    const double brought = mean_on(device, scene).value.x;
    scene.render.caustics = false;
    CHECK(brought > 1.05 * mean_on(device, scene).value.x);
  });
}
