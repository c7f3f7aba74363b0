// The plain C++ integrator that devices are timed against draws what the devices draw.
#include <glm/gtc/matrix_transform.hpp>

#include "bench/plain/whitted.h"
#include "catch.h"
#include "devices.h"
#include "every_kind.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

CompiledScene shipped(const std::string& name) {
  return compile(load_scene(SUNDOG_SOURCE_DIR "/scenes/" + name + ".json",
                            {"/image/width=48", "/image/height=40", "/render/samples=2"}));
}

/// Every solid, turned, glassy and shiny, seen from inside of a ball of water.
SceneDescription glass_and_shiny_solids() {
  SceneDescription scene = scenes::line_of_sight({0, 1.5, 7}, {0, 0, 0});
  scene.camera.fov = 50;
  scene.image.width = 64;
  scene.image.height = 48;
  LightDescription point, spot;
  point.position = {-4, 6, 5};
  spot.type = LightType::spot;
  spot.position = {4, 5, 4};
  spot.direction = {-4, -5, -4};
  scene.lights.insert(scene.lights.end(), {point, spot});
  const int glass = scenes::add_dielectric(scene, 1.5, {0.2, 0.1, 0.3}), floor = scenes::add_white(scene),
            shiny = scenes::add_white(scene),
            water = scenes::add_dielectric(scene, 1.33, {0.01, 0.02, 0.01}, -5);
  scene.materials[static_cast<std::size_t>(floor)].checker = true;
  scene.materials[static_cast<std::size_t>(shiny)].specular = dvec3(0.7);
  scene.materials[static_cast<std::size_t>(shiny)].blinn = true;
  scenes::place(scene, PlaneShape{}, floor, glm::translate(glm::dmat4(1), dvec3(0, -1.2, 0)));
  scenes::place(scene, SphereShape{9}, water);
  const auto shapes = with_every_solid({SphereShape{0.6}, BoxShape{{0.5, 0.4, 0.6}},
                                        CylinderShape{0.4, 0.6, true}, ConeShape{0.6, 0.2, 0.6, true},
                                        DiskShape{0.7, 0.3}, RectangleShape{{0.7, 0.4}}, TorusShape{0.5, 0.2},
                                        RoundBoxShape{{0.5, 0.4, 0.6}, 0.2}, CylinderShape{0.4, 0.6, false}});
  double x = -3;
  for (const Shape& shape : shapes) {
    const auto placed = glm::rotate(glm::translate(glm::dmat4(1), dvec3(x, 0.3 * x * x / 3 - 0.8, 0)), 0.6,
                                    dvec3(1, 0.4, 0.2));
    scenes::place(scene, shape, std::fmod(x, 2) == 0 ? glass : shiny, placed);
    x += 0.9;
  }
  return scene;
}

}  // namespace

TEST_CASE("the plain program's picture is the device's but for rounding") {
  for (const char* name :
       {"spheres", "hollow_ice", "hollow_ice_exact", "nested_glass", "cornell", "lights", "solids"}) {
    const CompiledScene scene =
        std::string(name) == "solids" ? compile(glass_and_shiny_solids()) : shipped(name);
    REQUIRE(plain_refusal(scene).empty());
    const Image plain = render_plain(scene);
    CAPTURE(name);
    // Devices are held against each other elsewhere, and some compile for minutes: the first one will do.
    Image image = render(scene, {test_devices().front()}).image;
    CHECK(plain_difference(plain, image) == "");
    for (std::size_t i = 0; i < image.data.size() / 20; ++i) image.data[i] += 0.1f;  // it can fail
    CHECK(plain_difference(plain, image) != "");
  }
}
