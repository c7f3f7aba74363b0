// Drivers that end a kernel's loops after so many rounds, without an error (Mesa's llvmpipe): every sample of
// a frame that needs more is traced all the same.
#include "render/render.h"

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;

TEST_CASE("every sample is traced to its end, however many loops they take") {
  SceneDescription scene = scenes::line_of_sight({0, 0, 5}, {0, 0, 0});
  scene.camera.fov = 20;
  scene.image.width = 2;
  scene.image.height = 1;
  scene.render.samples = 320;
  scene.render.max_depth = 8;
  scene.image.background_top = {0.2, 0.4, 0.9};
  scenes::place(scene, RoundBoxShape{{0.9, 0.9, 0.9}, 0.1}, scenes::add_dielectric(scene, 1.31));
  scenes::place(scene, SphereShape{0.6}, scenes::add_dielectric(scene, 1.5));
  const Image expected = scenes::render_on(test_devices().front(), scene).image;
  for (const DeviceInfo& device : test_devices()) {
    CAPTURE(device.label());
    const RenderResult result = scenes::render_on(device, scene);
    CHECK(result.counts[COUNT_PRIMARY] == 2 * 320);
    CHECK(result.counts[COUNT_FINISHED] == 2 * 2 * 320);
    for (std::size_t i = 0; i < expected.data.size(); ++i)
      CHECK(result.image.data[i] == Approx(expected.data[i]).margin(0.01));
  }
}
