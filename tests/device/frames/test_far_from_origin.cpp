// A scene looks the same wherever it lies.
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "base/image_compare.h"
#include "bench/plain/whitted.h"
#include "catch.h"
#include "devices.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

/// Glass with absorption, a mirror, a fractal and a mesh placed twice, under a light of each kind, in fog.
SceneDescription still_life() {
  const nlohmann::json document = parse_json(R"({"image": {"width": 80, "height": 64,
      "background": {"bottom": [0.3, 0.35, 0.4], "top": [0.6, 0.75, 0.95]}},
    "camera": {"position": [0.6, 1.4, 5.2], "target": [0, -0.2, 0], "fov": 40},
    "world": {"fog": {"color": [0.5, 0.5, 0.6], "density": 0.01}},
    "lights": [{"type": "ambient", "intensity": 0.3},
      {"type": "directional", "direction": [-1, -2, -1.5], "intensity": 0.3},
      {"type": "point", "position": [3, 5, 2], "falloff": {"constant": 1, "quadratic": 0.02}},
      {"type": "spot", "position": [-3, 4, 3], "target": [0, 0, 0], "outer_angle": 30, "intensity": 0.6}],
    "media": {"tea": {"ior": 1.33, "absorption": [0.2, 0.6, 1.5]}},
    "materials": {"tea": {"type": "dielectric", "medium": "tea", "specular": 0.3},
      "mirror": {"color": [0.1, 0.1, 0.1], "reflection": 0.8}, "matte": {"color": [0.8, 0.5, 0.3]},
      "floor": {"color": {"checker": [[0.1, 0.1, 0.1], [0.7, 0.7, 0.7]], "size": 0.7}}},
    "objects": [{"type": "plane", "point": [0, -1.2, 0], "material": "floor"},
      {"type": "round_box", "half": [0.6, 0.5, 0.3], "radius": 0.1, "center": [-0.9, -0.6, 1], "material": "tea"},
      {"type": "sphere", "radius": 0.5, "center": [-1.3, 0.8, 0], "material": "mirror"},
      {"type": "torus", "center": [0.9, -0.8, 1.2], "major_radius": 0.4, "material": "tea"},
      {"type": "fractal", "formula": "mandelbulb", "iterations": 5, "material": "matte",
       "transform": [{"scale": 0.6}, {"translate": [0.3, 0, 0]}]}]})",
                                             "test.json");
  const JsonContext context{"test.json"};
  SceneDescription scene = read_scene(JsonValue(document, context));
  scene.meshes.push_back(bumpy_sphere(8));
  for (const double x : {-0.4, 1.5}) {
    const dmat4 placed = glm::scale(glm::translate(dmat4(1), dvec3(x, 0.6 + x / 3, -0.8)), dvec3(0.5));
    scenes::place(scene, MeshShape{0}, x < 0 ? 0 : 2, glm::rotate(placed, x, glm::normalize(dvec3(1, 2, 0))));
  }
  return scene;
}

SceneDescription moved(SceneDescription scene, const dvec3& shift) {
  scene.camera.position += shift;
  scene.camera.target += shift;
  for (LightDescription& light : scene.lights) light.position += shift;
  for (Object& object : scene.objects) object.world_from_object[3] += glm::dvec4(shift, 0);
  return scene;
}

/// Along an axis, along a diagonal, and anywhere.
const dvec3 shifts[] = {{100, 0, 0},     {1e4, 0, 0},     {1e5, 0, 0},          {100, 100, 100},
                        {1e4, 1e4, 1e4}, {1e5, 1e5, 1e5}, {98765.4, -4321, 77}, {12345.678, -321.7, 98.6}};

constexpr double visible = 0.01;

/// 20 pixels of 40,000.
std::size_t few(const ImageDifference& d) { return d.pixels / 2000; }

/// A checkered floor about the world's origin, seen from near (x, 0, z).
SceneDescription floor_from(double x, double z) {
  SceneDescription scene = scenes::line_of_sight({x, 1.5, z + 4}, {x, 0, z});
  scene.camera.fov = 50;
  scene.image.width = scene.image.height = 64;
  const int white = scenes::add_white(scene);
  MaterialDescription& checkered = scene.materials[static_cast<std::size_t>(white)];
  checkered.ambient = dvec3(1);
  checkered.checker = true;
  checkered.checker_size = 0.7;
  scenes::place(scene, PlaneShape{}, white);
  return scene;
}

}  // namespace

TEST_CASE("a scene looks the same far from the origin as near it") {
  const SceneDescription near = still_life();
  on_picture_devices([&](const DeviceInfo& device) {
    const Image expected = scenes::render_on(device, near).image;
    for (const dvec3& shift : shifts) {
      CAPTURE(shift.x, shift.y, shift.z);
      const Image image = scenes::render_on(device, moved(near, shift)).image;
      const ImageDifference d = compare_images(image, expected, visible);
      CHECK(d.over_tolerance <= few(d));
    }
  });
}

TEST_CASE("the plain program draws a scene far from the origin as near it") {
  SceneDescription near = still_life();
  near.fog = {};
  std::erase_if(near.objects,
                [](const Object& object) { return std::holds_alternative<FieldShape>(object.shape); });
  const Image expected = render_plain(compile(near));
  const ImageDifference d =
      compare_images(render_plain(compile(moved(near, dvec3(1e5, -1e5, 1e4)))), expected, visible);
  CHECK(d.over_tolerance <= few(d));
}

TEST_CASE("an infinite pattern stays sharp far from its origin") {
  on_picture_devices([&](const DeviceInfo& device) {
    const Image expected = scenes::render_on(device, floor_from(0.2, 0.3)).image;
    for (const double periods : {1e3, 1e5}) {
      const double far = periods * 2 * 0.7;
      const ImageDifference d = compare_images(
          scenes::render_on(device, floor_from(0.2 - far, 0.3 + far)).image, expected, visible);
      CHECK(d.over_tolerance <= few(d));
    }
  });
}

TEST_CASE("positions in extra images are the world's") {
  const dvec3 shift(98765.4, -4321, 77);
  RenderOptions options;
  options.aovs = {"position"};
  const SceneDescription near = still_life();
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult here = scenes::render_on(device, near, options),
                       there = scenes::render_on(device, moved(near, shift), options);
    const std::vector<float>&a = here.aovs.at("position").data, &b = there.aovs.at("position").data;
    REQUIRE((a.size() == b.size() && a.size() % 3 == 0));
    std::size_t far = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) {
      if (a[i] == 0 && a[i + 1] == 0 && a[i + 2] == 0) continue;  // the background
      for (std::size_t k = 0; k < 3; ++k) {
        const double expected = double(a[i + k]) + shift[static_cast<int>(k)];
        far += std::abs(double(b[i + k]) - expected) >
               std::abs(expected) * 0x1p-23 + 1e-4 * std::abs(double(a[i + k])) + 1e-4;
      }
    }
    CHECK(far <= 3 * a.size() / 2000);
  });
}
