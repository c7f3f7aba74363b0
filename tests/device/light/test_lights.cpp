// Lights on a white floor in closed form, and what a surface does with the light that it returns by kr and
// kt.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A white floor seen at the origin under one light of intensity 1.
SceneDescription floor_under(LightDescription light) {
  SceneDescription scene = scenes::line_of_sight({1, 2, 0}, {0, 0, 0});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  scene.lights.push_back(light);
  return scene;
}

}  // namespace

TEST_CASE("a light falls off by 1 / (c + l d + q d^2), d from the surface") {
  LightDescription light;
  light.position = {3, 4, 0};
  light.falloff = {0.5, 0.25, 0.1};
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(scenes::pixel_on(device, floor_under(light)).x ==
          Approx(0.8 / (0.5 + 0.25 * 5 + 0.1 * 25)).epsilon(1e-5));
  });
}

TEST_CASE("a spot's light is full within the inner cone, none beyond the outer, and between them smooth") {
  LightDescription light;
  light.type = LightType::spot;
  light.position = {0, 2, 0};
  light.inner_angle = 20;
  light.outer_angle = 40;
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double degrees : {0.0, 19.0, 25.0, 33.0, 41.0}) {
      const double angle = glm::radians(degrees), inner = std::cos(glm::radians(20.0)),
                   outer = std::cos(glm::radians(40.0));
      light.direction = {std::sin(angle), -std::cos(angle), 0};  // turned away from the origin
      const double s = std::min(std::max((std::cos(angle) - outer) / (inner - outer), 0.0), 1.0);
      CHECK(scenes::pixel_on(device, floor_under(light)).x ==
            Approx(s * s * (3 - 2 * s)).epsilon(1e-5).margin(1e-6));
    }
  });
}

TEST_CASE("a light fades to nothing at its range, and glTF's spots by a square between their cones") {
  LightDescription light;
  light.type = LightType::spot;
  light.position = {0, 2, 0};
  light.inner_angle = 0;
  light.outer_angle = 40;
  light.square_edge = true;
  on_picture_devices([&](const DeviceInfo& device) {
    const auto lit = [&](double degrees, double range) {
      light.direction = {std::sin(glm::radians(degrees)), -std::cos(glm::radians(degrees)), 0};
      light.range = range;
      return scenes::pixel_on(device, floor_under(light)).x;
    };
    const double outer = std::cos(glm::radians(40.0));
    const auto squared = [&](double degrees) {
      const double s = (std::cos(glm::radians(degrees)) - outer) / (1 - outer);
      return s * s;
    };
    for (const double degrees : {10.0, 25.0, 33.0})
      CHECK(lit(degrees, 0) == Approx(squared(degrees)).epsilon(1e-5));
    CHECK(lit(25, 2.5) == Approx(squared(25) * (1 - std::pow(0.8, 4))).epsilon(1e-5));
    CHECK(lit(0, 1.9) == 0);
  });
}

TEST_CASE("a light behind a surface does not shine on it, nor one whose way is blocked behind half of it") {
  LightDescription light;
  on_picture_devices([&](const DeviceInfo& device) {
    light.position = {3, -4, 0};
    CHECK(scenes::pixel_on(device, floor_under(light)).x == 0);
    light.position = {3, 4, 0};
    const auto with_disk = [&](double height) {  // across the light's way
      SceneDescription scene = floor_under(light);
      scenes::place(scene, DiskShape{0.02, 0}, 0, glm::translate(glm::dmat4(1), {0.75 * height, height, 0}));
      return scene;
    };
    CHECK(scenes::pixel_on(device, with_disk(0.1)).x == 0);
    CHECK(scenes::pixel_on(device, with_disk(3.9)).x == 0);
    CHECK(scenes::pixel_on(device, with_disk(4.1)).x == Approx(0.8).epsilon(1e-5));
  });
}

TEST_CASE("total reflection of a plain material returns kr + kt") {
  SceneDescription scene = scenes::line_of_sight({-3, -1, 0}, {0, 0, 0});  // flat, from inside of the glass
  const int glass = scenes::add_dielectric(scene, 1.5);
  MaterialDescription& material = scene.materials[static_cast<std::size_t>(glass)];
  material.type = MaterialType::phong;
  material.reflection = {0.3, 0.1, 0};
  material.transmission = {0.5, 0.2, 0.6};
  scene.image.background_bottom = {1, 1, 1};  // the camera's side of the surface reflects to below
  scene.image.background_top = {1, 1, 1};
  scenes::place(scene, PlaneShape{}, glass);
  on_picture_devices([&](const DeviceInfo& device) {
    const dvec3 seen = scenes::pixel_on(device, scene);
    CHECK(seen.x == Approx(0.8).epsilon(1e-5));
    CHECK(seen.y == Approx(0.3).epsilon(1e-5));
    CHECK(seen.z == Approx(0.6).epsilon(1e-5));
  });
}

TEST_CASE("a ray ends when its throughput is below the cutoff, not sooner") {
  // Two mirrors of 0.5 that face each other: what glows is met once for each level.
  SceneDescription scene = scenes::line_of_sight({0, 0.5, 0}, {0, 0, 0}, {0, 0, 1});
  const int mirror = scenes::add_mirror(scene, 0.5, {1, 1, 1});
  scenes::place(scene, PlaneShape{}, mirror);
  scenes::place(scene, PlaneShape{}, mirror, glm::translate(glm::dmat4(1), {0, 1, 0}));
  scene.render.max_depth = 12;
  on_picture_devices([&](const DeviceInfo& device) {
    scene.render.cutoff = 0.1;  // 1, 0.5, 0.25 and 0.125 continue
    CHECK(scenes::pixel_on(device, scene).x == Approx(1.875).epsilon(1e-5));
    scene.render.cutoff = 0.2;
    CHECK(scenes::pixel_on(device, scene).x == Approx(1.75).epsilon(1e-5));
  });
}

TEST_CASE("a camera inside of several media is in the innermost, and out of them in their order") {
  // Three balls around the camera, each in the next: 1 wide layers that absorb in a colour each.
  SceneDescription scene = scenes::line_of_sight({0, 0, 0}, {0, 0, -1});
  for (int i = 0; i < 3; ++i) {
    dvec3 absorption(0);
    absorption[i] = 0.3 + 0.1 * i;
    scenes::place(scene, SphereShape{1.0 + i}, scenes::add_dielectric(scene, 1, absorption));
  }
  scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
  on_picture_devices([&](const DeviceInfo& device) {
    const dvec3 seen = scenes::pixel_on(device, scene);
    for (int i = 0; i < 3; ++i) CHECK(seen[i] == Approx(std::exp(-0.3 - 0.1 * i)).epsilon(1e-5));
  });
}

TEST_CASE("extra images hold depth along the view, the blended normal and the albedo") {
  SceneDescription scene = scenes::line_of_sight({0, 0, 3}, {0, 0, 0});
  scene.camera.fov = 60;
  scene.image.width = scene.image.height = 4;
  const int white = scenes::add_white(scene);
  MaterialDescription& material = scene.materials[static_cast<std::size_t>(white)];
  material.diffuse = {0.2, 0.4, 0.6};
  material.ambient = {0.9, 0.9, 0.9};
  const dvec3 normal = glm::normalize(dvec3(0.3, 0.2, 1));
  Mesh mesh;
  mesh.positions = {{-9, -9, 0}, {27, -9, 0}, {-9, 27, 0}};
  mesh.normals = {normal, normal, normal};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  scenes::place(scene, MeshShape{0}, white);
  RenderOptions options;
  options.aovs = {"depth", "normal", "albedo"};
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult result = scenes::render_on(device, scene, options);
    for (const float depth : result.aovs.at("depth").data) REQUIRE(depth == Approx(3).epsilon(1e-5));
    const std::vector<float>&normals = result.aovs.at("normal").data, &albedo = result.aovs.at("albedo").data;
    REQUIRE((normals.size() == 48 && albedo.size() == 48));
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const int c = static_cast<int>(i % 3);
      REQUIRE(normals[i] == Approx(normal[c]).epsilon(1e-5));
      REQUIRE(albedo[i] == Approx(material.diffuse[c]).epsilon(1e-5));
    }
  });
}
