// One frame on devices of different drivers: PoCL and, where Mesa is installed, llvmpipe.
#include <glm/gtc/matrix_transform.hpp>

#include "base/image_compare.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "render/render.h"
#include "scenes.h"

using namespace sundog;

namespace {

SceneDescription glass_over_a_floor() {
  SceneDescription scene = scenes::line_of_sight({0.6, 2.4, 6}, {0, 0.1, 0});
  scene.camera.fov = 35;
  scene.image.width = 64;
  scene.image.height = 48;
  scene.render.samples = 2;
  scene.render.max_depth = 5;
  scene.image.background_top = {0.2, 0.4, 0.9};
  LightDescription point;
  point.position = {-4, 6, 5};
  scene.lights.push_back(point);
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene), glm::dmat4(1));
  const int glass = scenes::add_dielectric(scene, 1.5);
  scenes::place(scene, SphereShape{0.9}, glass);
  // Bounded things for a tree, so that test_session's scene has the same kernel on llvmpipe.
  for (const double x : {-1.4, 1.5})
    scenes::place(scene, SphereShape{0.3}, glass, glm::translate(glm::dmat4(1), glm::dvec3(x, 0.3, 0.8)));
  return scene;
}

}  // namespace

TEST_CASE("a frame over two drivers is that of one alone, but for rays that rounding sends another way") {
  const CompiledScene scene = compile(glass_over_a_floor());
  const DeviceInfo& first = test_devices().front();
  const Image alone = render(scene, {first}).image;
  for (const DeviceInfo& other : test_devices()) {
    if (other.platform == first.platform) continue;
    CAPTURE(first.label(), other.label());
    RenderOptions halves;
    halves.split.kind = Split::Kind::fixed;
    halves.split.shares = {1, 1};
    const RenderResult both = render(scene, {first, other}, halves);
    for (const DeviceReport& report : both.devices) CHECK(report.pixels == 64 * 24);
    const ImageDifference difference = compare_images(both.image, alone, 0.02);
    CHECK(difference.over_tolerance * 200 <= difference.pixels);

    // By measured speed: one that only takes the faster one's cores is not even started.
    const RenderResult shared = render(scene, {first, other});
    CHECK(shared.complete);
    CHECK(compare_images(shared.image, alone, 0.02).over_tolerance * 200 <= difference.pixels);
    if (other.type == "cpu" && 64 * other.estimate < first.estimate) CHECK_FALSE(shared.devices[1].ready);
  }
}
