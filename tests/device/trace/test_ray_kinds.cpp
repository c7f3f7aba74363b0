// A lane's path and shadow rays wait on one stack and are traced by one loop (the compact tracer): the
// picture is the wide tracer's, whatever its lights, and has the same bits however lanes are grouped.
#include <glm/gtc/matrix_transform.hpp>

#include "bench/plain/whitted.h"
#include "catch.h"
#include "devices.h"
#include "same_bits.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A mirror and a further ball, of glass or white, over a floor. 37 pixels wide: some blocks of lanes are
/// cut.
SceneDescription balls_under_lights(int lights, bool glass) {
  SceneDescription scene = scenes::line_of_sight({0.6, 2.4, 6}, {0, 0.1, 0});
  scene.camera.fov = 35;
  scene.image.width = 37;
  scene.image.height = 21;
  scene.render.samples = 2;
  scene.render.max_depth = 5;
  scene.image.background_top = {0.2, 0.4, 0.9};
  for (int i = 0; i < lights; ++i) {
    LightDescription light;
    light.position = {-5.0 + 0.3 * i, 6, 5.0 - 0.2 * i};
    light.intensity = 1.5 / lights;
    scene.lights.push_back(light);
  }
  const int white = scenes::add_white(scene);
  scenes::place(scene, PlaneShape{}, white, glm::translate(glm::dmat4(1), dvec3(0, -1, 0)));
  scenes::place(scene, SphereShape{0.9}, glass ? scenes::add_dielectric(scene, 1.5) : white);
  scenes::place(scene, SphereShape{0.7}, scenes::add_mirror(scene, 0.8),
                glm::translate(glm::dmat4(1), dvec3(1.9, -0.3, -0.4)));
  return scene;
}

}  // namespace

TEST_CASE("a ray a lane sees every light, also more of them than shadow rays may wait") {
  const bool glass = GENERATE(false, true);
  const int lights = glass ? 16 : 40;
  SceneDescription scene = balls_under_lights(lights, glass);
  scene.render.tracer = Tracer::compact;
  const Image expected = render_plain(compile(scene));
  for (const DeviceInfo& device : picture_devices())
    DYNAMIC_SECTION(device.label() << ", " << lights << (glass ? " lights, glass" : " lights, opaque")) {
      CHECK(plain_difference(expected, scenes::render_on(device, scene).image) == "");
    }
}

TEST_CASE(
    "a ray a lane gives the same bits for every work-group, in one dimension and in two, and every tile") {
  SceneDescription scene = balls_under_lights(3, true);
  scene.render.tracer = Tracer::compact;
  on_picture_devices([&](const DeviceInfo& device) {
    const Image reference = scenes::render_on(device, scene).image;
    const auto check = [&](const RenderOptions& options) {
      CHECK(same_bits(scenes::render_on(device, scene, options).image, reference));
    };
    RenderOptions options;
    for (const WorkGroup& group : {WorkGroup{WorkGroup::Kind::fixed, 1, 1},
                                   {WorkGroup::Kind::fixed, 7, 1},
                                   {WorkGroup::Kind::fixed, 64, 1},
                                   {WorkGroup::Kind::fixed, 4, 2},
                                   {WorkGroup::Kind::fixed, 8, 8},
                                   {WorkGroup::Kind::driver, 0, 0}}) {
      options.work_group = group;
      check(options);
    }
    options.work_group = {};
    options.tile = 12;
    check(options);
  });
}
