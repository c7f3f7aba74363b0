// A mesh looks the same in whatever unit its file is, when its transform brings it to the same size.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/image_compare.h"
#include "catch.h"
#include "devices.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

/// A checkered, mirroring mesh before a plane, its coordinates times `unit` and placed so that this is
/// undone.
SceneDescription scene_in(double unit, bool smooth) {
  SceneDescription scene = scenes::line_of_sight({0.5, 1, 5}, {0, 0, 0});
  scene.camera.fov = 30;
  scene.image.width = scene.image.height = 40;
  scene.image.background_top = {0.2, 0.5, 0.9};
  LightDescription light;
  light.position = {-3, 4, 5};
  scene.lights.push_back(light);
  const int material = scenes::add_mirror(scene, 0.3);
  MaterialDescription& checkered = scene.materials[static_cast<std::size_t>(material)];
  checkered.diffuse = {0.7, 0.7, 0.7};
  checkered.checker = true;
  checkered.checker_size = 0.5 * unit;
  scene.meshes = {bumpy_sphere(16)};
  if (!smooth) scene.meshes[0].normals.clear();
  for (glm::vec3& p : scene.meshes[0].positions) p = glm::vec3(glm::dvec3(p) * unit);
  scenes::place(scene, MeshShape{0}, material, glm::scale(glm::dmat4(1), glm::dvec3(1 / unit)));
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene), glm::translate(glm::dmat4(1), {0, -1.3, 0}));
  return scene;
}

/// A mirroring ball on a floor that reaches `size` to all sides, of two triangles or, for 0, a plane.
SceneDescription ball_on_floor(float size, double slant, Tracer tracer) {
  SceneDescription scene = scenes::line_of_sight({0.5, 0.6, 3}, {0, 0, 0});
  scene.camera.fov = 40;
  scene.image.width = scene.image.height = 64;
  scene.render.tracer = tracer;
  LightDescription light;
  light.position = {2, 4, 3};
  scene.lights.push_back(light);
  const int mirror = scenes::add_mirror(scene, 0.5), white = scenes::add_white(scene);
  scenes::place(scene, SphereShape{0.5}, mirror);
  const glm::dmat4 slanted = glm::rotate(glm::dmat4(1), slant, glm::dvec3(0, 0, 1));
  if (size == 0) {
    scenes::place(scene, PlaneShape{}, white, glm::translate(slanted, glm::dvec3(0, -0.5, 0)));
    return scene;
  }
  Mesh floor;
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
    floor.positions.emplace_back(slanted * glm::dvec4(corner.x * size, -0.5, corner.y * size, 1));
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes = {floor};
  scenes::place(scene, MeshShape{0}, white);
  return scene;
}

}  // namespace

TEST_CASE("a floor of two huge triangles throws no shadow on itself") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double slant : {0.0, 0.3})
      for (const Tracer tracer : {Tracer::wide, Tracer::compact}) {
        if (tracer == Tracer::wide && device.native_vector_width <= 1) continue;
        const Image expected = scenes::render_on(device, ball_on_floor(0, slant, tracer)).image;
        for (const float size : {100.0f, 1e3f, 1e4f}) {
          CAPTURE(slant, size, tracer == Tracer::compact);
          const ImageDifference d = compare_images(
              scenes::render_on(device, ball_on_floor(size, slant, tracer)).image, expected, 0.03);
          CHECK(d.over_tolerance <= d.pixels / 25);  // the horizon, and shadows that begin a little farther
        }
      }
  });
}

TEST_CASE("a mesh of extreme coordinates that its transform brings to size looks as any other") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const bool smooth : {true, false}) {
      const Image expected = scenes::render_on(device, scene_in(1, smooth)).image;
      for (const double unit : {1e-30, 1e-16, 1e-12, 1e-10, 1e10, 1e12, 1e14, 1e30}) {
        CAPTURE(smooth, unit);
        const ImageDifference d =
            compare_images(scenes::render_on(device, scene_in(unit, smooth)).image, expected, 0.01);
        CHECK(d.over_tolerance <= d.pixels / 50);  // rounding at silhouettes and borders of checkers
        CHECK(d.non_finite == 0);
      }
    }
  });
}
