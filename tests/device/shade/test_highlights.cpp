// ks max(r.v, 0)^b: closed forms at its ends.
#include "bench/plain/whitted.h"
#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;

namespace {

/// A floor of kd = 0.5 and ks = 0.25, seen along (-0.8, -0.6, 0), the way its light travels: n.l is 0.6 and
/// r.v is 0.36 - 0.64 < 0.
SceneDescription against_the_light(double exponent, bool blinn) {
  SceneDescription scene = scenes::line_of_sight({8, 6, 0}, {0, 0, 0});
  const int floor = scenes::add_white(scene);
  MaterialDescription& material = scene.materials[static_cast<std::size_t>(floor)];
  material.diffuse = dvec3(0.5);
  material.specular = dvec3(0.25);
  material.exponent = exponent;
  material.blinn = blinn;
  scenes::place(scene, PlaneShape{}, floor);
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {-0.8, -0.6, 0};
  scene.lights.push_back(sun);
  return scene;
}

}  // namespace

TEST_CASE("a highlight of exponent 0 is seen from everywhere, any other not beyond a right angle") {
  struct Case {
    double exponent;
    bool blinn;
    double light;
  };
  const Case c = GENERATE(Case{0, false, 0.55}, Case{0, true, 0.55}, Case{1, false, 0.3},
                          Case{0.5, false, 0.3}, Case{1, true, 0.3 + 0.25 * 0.6});
  const SceneDescription scene = against_the_light(c.exponent, c.blinn);
  CHECK(double(render_plain(compile(scene)).data.at(0)) == Approx(c.light).epsilon(1e-5));
  for (const DeviceInfo& device : picture_devices())
    DYNAMIC_SECTION(device.label() << ", exponent " << c.exponent << (c.blinn ? ", Blinn" : "")) {
      CHECK(scenes::pixel_on(device, scene).x == Approx(c.light).epsilon(1e-5));
    }
}
