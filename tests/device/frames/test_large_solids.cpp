// Large things throw no shadows on themselves, however near the camera is.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

/// Beyond this ratio of size and distance floats do not tell on which side of a thing the camera is, and a
/// warning says so.
constexpr double most_sizes = 1e7;
constexpr double sizes[] = {1e-3, 1e3, 1e6}, distances[] = {1e-2, 3, 1e3};

glm::dmat4 moved(double x, double y) { return glm::translate(glm::dmat4(1), {x, y, 0}); }
glm::dmat4 turned(double degrees) {
  return glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::dvec3(0, 0, 1));
}

struct Placing {
  Shape shape;
  glm::dmat4 at;
};

/// Every solid of a size with a surface at the origin that faces +y.
std::vector<Placing> solids_below(double s) {
  return {{PlaneShape{}, moved(s, 0)},
          {SphereShape{s}, moved(0, -s)},
          {BoxShape{{s, s, s}}, moved(0, -s)},
          {RoundBoxShape{{s, s, s}, 0.2 * s}, moved(0, -s)},
          {RoundBoxShape{{s, s, s}, 0.5 * s}, moved(0, -0.5 * (1 + std::numbers::sqrt2) * s) * turned(45)},
          {CylinderShape{s, s}, moved(0, -s)},
          {CylinderShape{s, s}, moved(0, -s) * turned(90)},
          {ConeShape{s, 0.5 * s, s}, turned(glm::degrees(std::atan2(2, 0.5))) * moved(-0.75 * s, 0)},
          {DiskShape{s}, moved(0, 0)},
          {RectangleShape{{s, s}}, moved(0, 0)},
          {TorusShape{s, 0.3 * s}, moved(s, -0.3 * s)},
          {TorusShape{s, 0.01 * s}, moved(s, -0.01 * s)},
          {TorusShape{s, 0.3 * s}, moved(0, -1.3 * s) * turned(90)},
          {TorusShape{s, 0.05 * s}, moved(0, -1.05 * s) * turned(90)}};
}

SceneDescription seen_from(double distance, double elevation, const LightDescription& light) {
  const double e = glm::radians(elevation);
  SceneDescription scene =
      scenes::line_of_sight({0, distance * std::sin(e), distance * std::cos(e)}, {0, 0, 0});
  scene.camera.fov = 30;
  scene.image.width = scene.image.height = 16;
  scene.image.background_bottom = scene.image.background_top = {0, 0, 1};
  scene.lights = {light};
  if (light.type == LightType::point) scene.lights[0].position = scene.camera.position;
  scenes::add_white(scene);
  return scene;
}

LightDescription sun(double elevation, double azimuth) {
  LightDescription light;
  light.type = LightType::directional;
  const double e = glm::radians(elevation), a = glm::radians(azimuth);
  light.direction = {-std::cos(e) * std::sin(a), -std::sin(e), -std::cos(e) * std::cos(a)};
  return light;
}

/// Pixels that show something, and nothing of its light.
int black_pixels(const DeviceInfo& device, const SceneDescription& scene) {
  const Image image = scenes::render_on(device, scene).image;
  int black = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4)
    black += image.data[i] == 0 && image.data[i + 1] == 0 && image.data[i + 2] == 0;
  return black;
}

/// Checks a solid whose surface faces +y as far as `flat` from the origin: no pixel is black.
void check_lit(const DeviceInfo& device, double flat, double distance, const auto& put) {
  if (distance < flat) {  // all that is seen faces the sun
    SceneDescription scene = seen_from(distance, 20, sun(20, 70));
    put(scene);
    CHECK(black_pixels(device, scene) == 0);
  }
  if (distance < 1e-4 * flat) return;  // a lamp at the camera is nearer than the offset
  SceneDescription scene = seen_from(distance, 30, {});
  put(scene);
  CHECK(black_pixels(device, scene) == 0);
}

}  // namespace

TEST_CASE("no large solid throws shadows on itself, from however near it is seen") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double size : sizes)
      for (const double distance : distances)
        for (const Placing& solid : solids_below(size)) {
          if (size > most_sizes * distance) continue;
          CAPTURE(size, distance, solid.shape.index());
          const bool thin = std::holds_alternative<TorusShape>(solid.shape);
          check_lit(device, (thin ? 0.0005 : 0.05) * size, distance,
                    [&](SceneDescription& scene) { scenes::place(scene, solid.shape, 0, solid.at); });
        }
  });
}

TEST_CASE("no large mesh throws shadows on itself, wherever its own origin is") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double size : sizes)
      for (const double distance : distances)
        for (const float away : {0.0f, 500.0f}) {
          CAPTURE(size, distance, away);
          check_lit(device, 0.02 * size, distance, [&](SceneDescription& scene) {
            scene.meshes = {bumpy_sphere(16, 0)};
            Mesh& mesh = scene.meshes.front();
            mesh.normals.clear();
            for (glm::vec3& position : mesh.positions) position.y += away;
            const glm::dmat4 placed = glm::scale(moved(0, -size), glm::dvec3(size)) * turned(33);
            scenes::place(scene, MeshShape{0}, 0, placed * moved(0, -away));
          });
        }
  });
}

TEST_CASE("a mirror that is a ball of a thousand times the distance loses nothing of the sky") {
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = seen_from(3, 30, sun(20, 70));
    scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
    scene.materials[0] = {};
    scene.materials[0].ambient = scene.materials[0].diffuse = {0, 0, 0};
    scene.materials[0].reflection = {1, 1, 1};
    scenes::place(scene, SphereShape{3000}, 0, moved(0, -3000));
    for (const float value : scenes::render_on(device, scene).image.data) CHECK(value == Approx(1));
  });
}

TEST_CASE("a solid pressed flat, to a ten-millionth, is as wide as before and lit") {
  const Shape shapes[] = {SphereShape{1}, CylinderShape{1, 1}, RoundBoxShape{{1, 1, 1}, 0.5},
                          BoxShape{},     ConeShape{},         TorusShape{1, 0.3},
                          LatheShape{}};
  on_picture_devices([&](const DeviceInfo& device) {
    for (const Shape& shape : shapes)
      for (const int axis : {0, 1, 2}) {
        const auto picture = [&](double thickness) {
          glm::dvec3 from(0), scale(1);
          from[axis] = 4;
          scale[axis] = thickness;
          SceneDescription scene = scenes::line_of_sight(
              from, {0, 0, 0}, axis == 1 ? glm::dvec3(0.1, 0, 1) : glm::dvec3(0.1, 1, 0));
          scene.camera.fov = 40;
          scene.image.width = scene.image.height = 32;
          scene.image.background_bottom = scene.image.background_top = {0, 0, 1};
          scene.lights = {{}};
          scene.lights[0].position = from;
          scenes::place(scene, shape, scenes::add_white(scene), glm::scale(glm::dmat4(1), scale));
          return scenes::render_on(device, scene).image.data;
        };
        const std::vector<float> flat = picture(1e-4);
        for (const double thickness : {1e-6, 1e-7, 1e-9}) {
          CAPTURE(shape.index(), axis, thickness);
          const std::vector<float> flatter = picture(thickness);
          std::size_t apart = 0;
          for (std::size_t i = 0; i < flat.size(); ++i) apart += std::abs(flat[i] - flatter[i]) > 0.02f;
          CHECK(apart <= 12);  // of 4096: at the rim
        }
      }
  });
}
