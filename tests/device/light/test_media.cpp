// Overlapping solids: what has no interface vanishes, and media resolve by priority and by order of entry,
// not by the order in the file.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

glm::dmat4 at(dvec3 position) { return glm::translate(glm::dmat4(1), position); }

// Light that passes interfaces between these indices in turn at normal incidence.
double passed(std::initializer_list<double> indices) {
  double light = 1, before = *indices.begin();
  for (const double after : indices) {
    light *= 1 - std::pow((after - before) / (after + before), 2);
    before = after;
  }
  return light;
}

// A small picture of a checkered floor with solids over it.
SceneDescription over_a_checkered_floor() {
  SceneDescription scene = scenes::line_of_sight({0.4, 2.2, 6}, {0, 0, 0});
  scene.camera.fov = 40;
  scene.image.width = 24;
  scene.image.height = 20;
  scene.image.background_top = {0.2, 0.4, 0.9};
  LightDescription point;
  point.position = {-5, 6, 4};
  scene.lights.push_back(point);
  const int floor = scenes::add_white(scene);
  scene.materials[static_cast<std::size_t>(floor)].checker = true;
  scenes::place(scene, PlaneShape{}, floor, at({0, -1, 0}));
  return scene;
}

// Only the first reflections and refractions of the far side: what the camera sees along the axis through
// both solids.
SceneDescription looking_through(double first_index, int first_priority, double second_index,
                                 int second_priority, bool swapped) {
  SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
  const int first = scenes::add_dielectric(scene, first_index, {0, 0, 0}, first_priority);
  const int second = scenes::add_dielectric(scene, second_index, {0, 0, 0}, second_priority);
  // Entered in this order: first spans z in [-1, 3], second z in [-3, 1].
  scenes::place(scene, BoxShape{{5, 5, 2}}, first, at({0, 0, 1}));
  scenes::place(scene, BoxShape{{5, 5, 2}}, second, at({0, 0, -1}));
  if (swapped) std::swap(scene.objects[0], scene.objects[1]);
  scenes::place(scene, DiskShape{1, 0}, scenes::add_glow(scene, {1, 1, 1}),
                glm::rotate(at({0, 0, -5}), glm::radians(90.0), dvec3(1, 0, 0)));
  scene.render.max_depth = 5;  // the straight path has five rays at most; each echo between faces needs more
  return scene;
}

}  // namespace

TEST_CASE("a matched-index interface vanishes to the last bit") {
  const SceneDescription bare = over_a_checkered_floor();
  SceneDescription filled = bare;
  const int priority = GENERATE(0, 3);
  const int nothing = scenes::add_dielectric(filled, 1, {0, 0, 0}, priority);
  scenes::place(filled, SphereShape{0.8}, nothing);
  scenes::place(filled, BoxShape{{0.5, 0.5, 0.5}}, nothing, at({0.6, 0.2, 0.5}));
  scenes::place(filled, TorusShape{1, 0.3}, nothing, at({0, 0.3, 0}));
  on_picture_devices([&](const DeviceInfo& device) {
    REQUIRE(scenes::render_on(device, bare).image.data == scenes::render_on(device, filled).image.data);
  });
}

TEST_CASE("a solid inside one of the same medium vanishes") {
  SceneDescription bare = over_a_checkered_floor();
  const int glass = scenes::add_dielectric(bare, 1.5, {0.1, 0.2, 0.3}, 1);
  scenes::place(bare, SphereShape{0.9}, glass);
  SceneDescription filled = bare;
  scenes::place(filled, SphereShape{0.4}, glass, at({0.1, 0.2, 0.1}));
  on_picture_devices([&](const DeviceInfo& device) {
    // A ray that crosses what it cannot see waits for others, so a pixel's sum may be made in another order.
    const std::vector<float> without = scenes::render_on(device, bare).image.data,
                             with = scenes::render_on(device, filled).image.data;
    REQUIRE(without.size() == with.size());
    float farthest = 0;
    for (std::size_t i = 0; i < with.size(); ++i)
      farthest = std::max(farthest, std::abs(with[i] - without[i]));
    REQUIRE(farthest <= 5e-7f);
  });
}

TEST_CASE("where solids overlap the higher priority wins, whatever was entered first") {
  const bool swapped = GENERATE(false, true);
  // Echoes between the faces add less than the tolerance: each is the product of two reflectances.
  const auto near = [](double expected) { return Approx(expected).margin(6e-3); };
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(scenes::pixel_on(device, looking_through(1.5, 2, 1.2, 1, swapped)).x ==
          near(passed({1, 1.5, 1.2, 1})));
    CHECK(scenes::pixel_on(device, looking_through(1.5, 1, 1.2, 2, swapped)).x ==
          near(passed({1, 1.5, 1.2, 1})));
  });
}

TEST_CASE("priority decides how far each medium reaches") {
  // The overlap is 2 long: absorbing in the first medium only, it dims by the overlap's length when the first
  // has the priority.
  for (const bool first_wins : {true, false}) {
    SceneDescription scene = looking_through(1, first_wins ? 2 : 1, 1, first_wins ? 1 : 2, false);
    scene.media[1].absorption = dvec3(0.5);
    scene.media[2].absorption = dvec3(0.125);
    const double expected = first_wins ? std::exp(-0.5 * 4 - 0.125 * 2) : std::exp(-0.5 * 2 - 0.125 * 4);
    on_picture_devices([&](const DeviceInfo& device) {
      CHECK(scenes::pixel_on(device, scene).x == Approx(expected).epsilon(1e-5));
    });
  }
}

TEST_CASE("without priorities the solid entered last counts") {
  SceneDescription scene = looking_through(1, 0, 1, 0, GENERATE(false, true));
  scene.media[1].absorption = dvec3(0.5);
  scene.media[2].absorption = dvec3(0.125);
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(scenes::pixel_on(device, scene).x == Approx(std::exp(-0.5 * 2 - 0.125 * 4)).epsilon(1e-5));
  });
}

TEST_CASE("media work in any order of the objects in the file") {
  SceneDescription scene = over_a_checkered_floor();
  const int ice = scenes::add_dielectric(scene, 1.31, {0.1, 0.05, 0.02}, 10);
  const int water = scenes::add_dielectric(scene, 1.333, {0.5, 0.1, 0.05}, 5);
  const int air = scenes::add_dielectric(scene, 1, {0, 0, 0}, 20);
  scenes::place(scene, RoundBoxShape{{1, 0.9, 1}, 0.1}, ice);
  scenes::place(scene, SphereShape{0.7}, air, at({0, 0.1, 0}));
  scenes::place(scene, SphereShape{0.8}, water, at({0.1, -0.1, 0.9}));
  scenes::place(scene, SphereShape{0.2}, air, at({0.1, -0.1, 1.1}));
  std::vector<Object> objects = scene.objects;
  on_picture_devices([&](const DeviceInfo& device) {
    const std::vector<float> reference = scenes::render_on(device, scene).image.data;
    for (int turn = 0; turn < 4; ++turn) {
      std::rotate(objects.begin(), objects.begin() + 1, objects.end());
      SceneDescription turned = scene;
      turned.objects = objects;
      CHECK(scenes::render_on(device, turned).image.data == reference);
    }
  });
}
