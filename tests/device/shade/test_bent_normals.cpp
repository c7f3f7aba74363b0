// Normals of a model that say much else than its faces, as those of bevels do.
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "same_bits.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// A square in y = 0 whose normals are turned by `tilt` degrees, seen from 20 degrees to its own, in a white
/// surrounding. Above 55 degrees they mirror the viewer below the face.
SceneDescription square(double tilt) {
  SceneDescription scene =
      scenes::line_of_sight({5 * std::sin(20 * degree), 5 * std::cos(20 * degree), 0}, {0, 0, 0}, {0, 0, 1});
  scene.image.width = scene.image.height = 12;
  scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
  scene.render.integrator = "path";
  scene.render.samples = 64;
  Mesh mesh;
  mesh.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
  mesh.normals.assign(4, glm::vec3(std::sin(tilt * degree), std::cos(tilt * degree), 0));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.source_vertex_count = 4;
  scene.meshes.push_back(mesh);
  return scene;
}

double mean_of(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4) sum += double(image.data[i]);
  return 4 * sum / double(image.data.size());
}

}  // namespace

TEST_CASE("glossy surfaces whose normals mirror the viewer below their faces are not black by path") {
  for (const bool layered : {false, true})
    for (const double tilt : {30.0, 60.0, 75.0, 100.0}) {
      SceneDescription scene = square(tilt);
      const int metal = scenes::add_mirror(scene, 1);
      scene.materials.back().roughness = 0.2;
      if (layered) {
        MediumDescription inside;
        set_openpbr({.base_color = dvec3(1), .base_metalness = 1, .specular_roughness = 0.2},
                    scene.materials.back(), inside);
      }
      scenes::place(scene, MeshShape{0}, metal);
      on_picture_devices([&](const DeviceInfo& device) {
        const double light = mean_of(scenes::render_on(device, scene).image);
        INFO((layered ? "layered, " : "") << tilt << " degrees: " << light);
        CHECK(light > (tilt == 30.0 ? 0.98 : 0.4));
        CHECK(light < 1.01);
      });
    }
}

TEST_CASE("smooth glass with bent normals has the same bits beside rough metal") {
  nlohmann::json document = parse_json(R"({
    "camera": {"position": [0, 1, 4], "target": [0.7, 0.8, 0], "fov": 40},
    "image": {"width": 24, "height": 18}, "render": {"integrator": "path", "samples": 4},
    "textures": {"ramp": {"type": "gradient"}},
    "materials": {"floor": {}, "metal": {"reflection": 0.5, "roughness": 0.2},
      "glass": {"type": "dielectric", "ior": 1.2, "emission": "ramp", "normal_map": {"texture": "ramp"}}},
    "objects": [{"type": "plane", "material": "floor"},
      {"type": "sphere", "center": [0.7, 1.1, 0.4], "material": "glass"}]})",
                                       "test.json");
  const auto read = [&] {
    const JsonContext context{"test.json"};
    return read_scene(JsonValue(document, context));
  };
  const SceneDescription alone = read();
  document["objects"].push_back({{"type", "sphere"}, {"material", "metal"}, {"center", {0, 1, 50}}});
  document["objects"].back()["radius"] = 1e-3;
  const SceneDescription beside = read();
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(same_bits(scenes::render_on(device, alone).image, scenes::render_on(device, beside).image));
  });
}
