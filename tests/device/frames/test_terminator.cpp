// Light on coarse meshes ends where their smooth normals say, not at their facets.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "devices.h"
#include "scene/lamps.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

constexpr int side = 48;

/// White things under a sun from the right, seen from the front.
SceneDescription under_sun(const char* integrator) {
  SceneDescription scene = scenes::line_of_sight({0, 0, 20}, {0, 0, 0});
  scene.camera.fov = 6;
  scene.image.width = scene.image.height = side;
  scene.render.integrator = integrator;
  scene.render.samples = scene.render.integrator == "path" ? 4 : 1;
  scene.lights.clear();
  scene.lights.emplace_back().type = LightType::directional;
  scene.lights.back().direction = {-1, -0.15, -0.1};
  scenes::add_white(scene);
  return scene;
}

/// The sun becomes a small lamp there, whose surface shadow rays may meet.
void bring_near(LightDescription& light, LightType type) {
  const glm::dvec3 towards = -glm::normalize(light.direction);
  light.type = type;
  light.position = 6.0 * towards;
  light.size = {0.5, 0.5};
  light.radius = 0.25;
  light.intensity = 400;
}

/// The greatest difference of their pixels well within the ball's outline.
double difference(const Image& a, const Image& b) {
  double most = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      if (std::hypot(x + 0.5 - 0.5 * side, y + 0.5 - 0.5 * side) > 0.75 * 0.5 * side) continue;
      const auto i = static_cast<std::size_t>(4 * (y * side + x));
      most = std::max(most, std::abs(double(a.data[i]) - double(b.data[i])));
    }
  return most;
}

}  // namespace

TEST_CASE("the light on a coarse ball ends where it does on a sphere, by both integrators") {
  const Mesh coarse = bumpy_sphere(8, 0);
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.4, glm::dvec3(0.3, 1, 0.2));
  const glm::dmat4 pressed = glm::scale(turned, glm::dvec3(1, 0.9, 0.95));
  for (const DeviceInfo& device : picture_devices())
    for (const char* integrator : {"whitted", "path"})
      for (const glm::dmat4& at : {glm::dmat4(1), turned, pressed}) {
        CAPTURE(device.label(), integrator, at[1][1]);
        SceneDescription ball = under_sun(integrator), sphere = ball;
        ball.meshes = {coarse};
        scenes::place(ball, MeshShape{0}, 0, at);
        scenes::place(sphere, SphereShape{1}, 0, at);
        CHECK(difference(scenes::render_on(device, ball).image, scenes::render_on(device, sphere).image) <
              0.07);
      }
}

TEST_CASE("a lamp with an extent does not shadow a coarse ball, by both integrators") {
  for (const DeviceInfo& device : picture_devices())
    for (const char* integrator : {"whitted", "path"})
      for (const LightType type : {LightType::rectangle, LightType::sphere}) {
        CAPTURE(device.label(), integrator, type);
        SceneDescription ball = under_sun(integrator);
        bring_near(ball.lights.back(), type);
        SceneDescription sphere = ball;
        ball.meshes = {bumpy_sphere(8, 0)};
        scenes::place(ball, MeshShape{0}, 0);
        scenes::place(sphere, SphereShape{1}, 0);
        add_lamps(ball);
        add_lamps(sphere);
        CHECK(difference(scenes::render_on(device, ball).image, scenes::render_on(device, sphere).image) <
              0.15);
      }
}

TEST_CASE("normals far from a face's own do not move what shades it") {
  Mesh wall;
  wall.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  wall.normals.assign(4, glm::normalize(glm::dvec3(0, 1, 0.3)));
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const DeviceInfo& device : picture_devices())
    for (const char* integrator : {"whitted", "path"}) {
      CAPTURE(device.label(), integrator);
      SceneDescription scene = under_sun(integrator);
      scene.camera.fov = 0.5;
      scene.lights.back().direction = {0, -1, -1};
      scene.meshes = {wall};
      scenes::place(scene, MeshShape{0}, 0);
      const Image lit = scenes::render_on(device, scene).image;
      scenes::place(scene, BoxShape{{1, 0.1, 0.02}}, 0, glm::translate(glm::dmat4(1), {0, 0.15, 0.15}));
      const Image shaded = scenes::render_on(device, scene).image;
      const auto middle = static_cast<std::size_t>(4 * (side / 2 * side + side / 2));
      CHECK(lit.data[middle] > 0.5f);
      CHECK(shaded.data[middle] < 0.5f * lit.data[middle]);  // by path the box sends some light
    }
}
