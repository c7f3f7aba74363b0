// Shafts to area lights: they give surfaces the shadows that rays find.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "every_kind.h"
#include "render/render.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

struct Numbers {
  u32 state = 1;
  double operator()(double low, double high) {
    state = state * 1664525u + 1013904223u;
    return low + (high - low) * double(state >> 8) / 16777216.0;
  }
  dvec3 place(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

LightDescription small_light(LightType type, Numbers& next) {
  LightDescription light;
  light.type = type;
  light.position = dvec3(0, 4.5, 0) + next.place(2.5);
  light.direction = next.place(0.5) - light.position;
  light.size = {0.8, 0.5};
  light.radius = 0.35;
  light.samples = 8;
  light.intensity = 60;
  return light;
}

Mesh tetrahedron() {
  Mesh mesh;
  mesh.positions = {{-1, -0.5f, -1}, {1, -0.5f, -1}, {0, -0.5f, 1}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  mesh.source_vertex_count = 4;
  return mesh;
}

/// Solids of every kind, a mesh and a pane that filters light, here and there in a room without a ceiling,
/// before one small light.
SceneDescription crowd_under(LightType type, u32 seed) {
  Numbers next{seed};
  SceneDescription scene = scenes::line_of_sight({0.5, 4, 9}, {0, 0.6, 0});
  scene.camera.fov = 45;
  scene.image.width = 64;
  scene.image.height = 48;
  const int white = scenes::add_white(scene), shiny = scenes::add_white(scene),
            pane = scenes::add_white(scene);
  scene.materials[std::size_t(shiny)].specular = dvec3(0.5);
  scene.materials[std::size_t(shiny)].exponent = 8;
  scene.materials[std::size_t(pane)].transmission = dvec3(0.5);
  scenes::place(scene, PlaneShape{}, white);
  scenes::place(scene, BoxShape{{6, 6, 0.1}}, white, glm::translate(glm::dmat4(1), {0, 0, -4}));
  const auto anywhere = [&] {
    const glm::dmat4 moved = glm::translate(glm::dmat4(1), {next(-3, 3), next(0.3, 2.2), next(-3, 3)});
    return glm::scale(glm::rotate(moved, next(0, 6), next.place(1) + dvec3(0, 1.5, 0)),
                      dvec3(next(0.3, 0.7)));
  };
  for (const Shape& shape : solids_of_many_sizes())
    scenes::place(scene, shape, next(0, 1) < 0.7 ? white : shiny, anywhere());
  scenes::place(scene, BoxShape{{0.8, 0.8, 0.05}}, pane, anywhere());
  scene.meshes.push_back(tetrahedron());
  scenes::place(scene, MeshShape{0}, white, anywhere());
  scene.lights.push_back(small_light(type, next));
  return scene;
}

struct Answers {
  std::size_t same = 0, whole = 0, dark = 0, wrong = 0;
  std::uint64_t rays_by_shafts = 0, rays = 0;
};

/// Counts pixels by what shafts said of them, where the rays of the other picture are the same samples. A
/// light so small looks much the same from all of its places: a shadow ray that is missing, or one too many,
/// stands out.
void compare(const RenderResult& shafts, const RenderResult& rays, Answers* answers) {
  const float bright = *std::ranges::max_element(rays.image.data);
  for (std::size_t i = 0; i < shafts.image.data.size(); i += 4) {
    const float a = shafts.image.data[i], b = rays.image.data[i];
    if (a == 0 && b == 0)
      ++answers->dark;
    else if (std::abs(a - b) <= 1e-5f * bright)
      ++answers->same;
    else if (std::abs(a - b) < 0.02f * bright)
      ++answers->whole;
    else
      ++answers->wrong;
  }
  answers->rays_by_shafts += shafts.counts[COUNT_SHADOW];
  answers->rays += rays.counts[COUNT_SHADOW];
}

}  // namespace

TEST_CASE("where shafts tell what reaches a surface, shadow rays find the same") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const LightType type : {LightType::rectangle, LightType::disk, LightType::sphere}) {
      Answers all;
      for (const u32 seed : {1u, 2u, 3u}) {
        CompiledScene scene = compile(crowd_under(type, seed));
        REQUIRE(scene.info.shafts == 1);
        const RenderResult by_shafts = render(scene, {device});
        scene.info.shafts = 0;
        compare(by_shafts, render(scene, {device}), &all);
      }
      INFO(int(type) << ": " << all.same << " the same, " << all.whole << " whole, " << all.dark << " dark, "
                     << all.wrong << " wrong, " << all.rays_by_shafts << " rays of " << all.rays);
      CHECK(all.wrong == 0);
      CHECK(all.same > 1000);
      CHECK(all.rays_by_shafts < all.rays * 2 / 3);
      if (type == LightType::rectangle) CHECK(all.whole > 1000);
    }
  });
}

TEST_CASE("a lamp shines through an open tube whose wall hides all of its corners") {
  SceneDescription scene = scenes::line_of_sight({0, 0.8, 2}, {0, 0, 0});
  scene.camera.fov = 2;
  scene.image.width = scene.image.height = 16;
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  CylinderShape tube;
  tube.radius = 0.3;
  tube.half_height = 0.5;
  tube.capped = false;
  scenes::place(scene, tube, scenes::add_white(scene), glm::translate(glm::dmat4(1), {0, 1.5, 0}));
  LightDescription light;
  light.type = LightType::rectangle;
  light.position = {0, 4, 0};
  light.direction = {0, -1, 0};
  light.size = {1, 1};
  light.samples = 16;
  light.intensity = 60;
  scene.lights.push_back(light);
  on_picture_devices([&](const DeviceInfo& device) {
    CompiledScene compiled = compile(scene);
    REQUIRE(compiled.info.shafts == 1);
    const RenderResult by_shafts = render(compiled, {device});
    compiled.info.shafts = 0;
    const RenderResult by_rays = render(compiled, {device});
    for (std::size_t i = 0; i < by_rays.image.data.size(); i += 4) {
      REQUIRE(by_rays.image.data[i] > 0);
      CHECK(by_shafts.image.data[i] == Approx(by_rays.image.data[i]).epsilon(1e-4));
    }
  });
}

TEST_CASE("a rectangle that stands in the horizon lights a floor by what is above it, without noise") {
  // From the origin: the part above the floor's plane of an upright rectangle is a rectangle as well.
  LightDescription light;
  light.type = LightType::rectangle;
  light.position = {0, 0.3, -2};
  light.direction = {0, 0, 1};
  light.size = {3, 1};
  light.hidden = true;
  SceneDescription scene = scenes::line_of_sight({1, 1, 0}, {0, 0, 0});
  scenes::place(scene, DiskShape{0.5, 0}, scenes::add_white(scene));
  scene.lights.push_back(light);
  // Lambert's sum over the upper side: the others, in planes through the normal or in the horizon, cancel.
  const dvec3 a = glm::normalize(dvec3(-1.5, 0.8, -2)), b = glm::normalize(dvec3(1.5, 0.8, -2)),
              c = glm::normalize(dvec3(-1.5, 0, -2)), d = glm::normalize(dvec3(1.5, 0, -2));
  const auto side = [](const dvec3& from, const dvec3& to) {
    return std::acos(glm::dot(from, to)) * glm::normalize(glm::cross(from, to)).y;
  };
  const double irradiance = std::abs(side(a, b) + side(d, c)) / 2;
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(scenes::pixel_on(device, scene).x == Approx(irradiance / 3.14159265358979).epsilon(1e-5));
  });
}

TEST_CASE("a visible lamp does not block its own light") {
  // As scene files have it: the lamp is an object too, in the picture's upper half.
  const auto scene_with = [](bool hidden) {
    const nlohmann::json document = parse_json(
        fmt::format(
            R"({{"camera": {{"position": [0, 4, 7], "target": [0, 2, 0]}}, "image": {{"width": 32, "height": 24}},
          "materials": {{"white": {{"color": [0.8, 0.8, 0.8]}}}}, "objects": [{{"type": "plane", "material": "white"}}],
          "lights": [{{"type": "rectangle", "position": [0, 5, 0], "direction": [0, -1, 0], "size": [1, 1],
            "hidden": {}}}]}})",
            hidden),
        "test.json");
    const JsonContext context{"test.json"};
    return compile(read_scene(JsonValue(document, context)));
  };
  RenderOptions options;
  options.kernels = KernelChoice::general;  // which both share with other tests
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(render(scene_with(true), {device}, options).counts[COUNT_SHADOW] == 0);
    CHECK(render(scene_with(false), {device}, options).counts[COUNT_SHADOW] == 0);
  });
}
