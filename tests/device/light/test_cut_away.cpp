// Places that are cut away from surfaces, and sides that surfaces do not have, are no surfaces: not for
// max_depth, nor for what the camera has hit.
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A line of sight through `count` disks of a material, before a wall that returns 0.5 with either
/// integrator.
SceneDescription behind_disks(const std::string& integrator, int depth, int count,
                              const MaterialDescription& material) {
  SceneDescription scene = scenes::line_of_sight({0, 0, 100}, {0, 0, 0});
  scene.render.integrator = integrator;
  scene.render.max_depth = depth;
  const int wall = scenes::add_white(scene);
  MaterialDescription& returning = scene.materials.back();
  // Shadow rays of paths see those sides that they come to: then the wall shines by itself.
  (material.one_sided ? returning.emission : returning.diffuse) = dvec3(0.5);
  if (material.one_sided) returning.diffuse = dvec3(0);
  scenes::place(scene, DiskShape{5, 0}, wall, glm::rotate(glm::dmat4(1), 1.5707963267948966, {1, 0, 0}));
  LightDescription lamp;
  lamp.type = LightType::directional;
  lamp.direction = {0, 0, -1};
  scene.lights.assign(1, lamp);
  scene.materials.push_back(material);
  const int disks = static_cast<int>(scene.materials.size()) - 1;
  for (int i = 1; i <= count; ++i)
    scenes::place(scene, DiskShape{5, 0}, disks,
                  glm::rotate(glm::translate(glm::dmat4(1), {0, 0, i}), 1.5707963267948966, {1, 0, 0}));
  return scene;
}

MaterialDescription white() {
  MaterialDescription material;
  material.diffuse = dvec3(1);
  return material;
}

}  // namespace

TEST_CASE("behind places that are cut away surfaces are seen at every depth") {
  MaterialDescription gone = white(), below_cutoff = white(), behind = white(), clear;
  gone.opacity = 0;
  below_cutoff.opacity = 0.4, below_cutoff.cutoff = 0.5;
  behind.one_sided = true;
  clear.diffuse = clear.ambient = clear.specular = dvec3(0);
  clear.transmission = dvec3(1);
  for (const MaterialDescription& material : {gone, below_cutoff, behind, clear})
    for (const char* integrator : {"whitted", "path"})
      for (const int depth : {1, 8}) {
        SceneDescription scene = behind_disks(integrator, depth, 20, material);
        if (material.one_sided)
          for (std::size_t i = 1; i < scene.objects.size(); ++i)
            scene.objects[i].world_from_object =
                glm::rotate(scene.objects[i].world_from_object, 3.141592653589793, {1, 0, 0});
        on_picture_devices([&](const DeviceInfo& device) {
          INFO(integrator << ", depth " << depth << (material.one_sided ? ", one-sided" : ""));
          const RenderResult result = scenes::render_on(device, scene);
          CHECK(double(result.image.data[0]) == Approx(0.5));
          CHECK(result.counts[COUNT_PRIMARY_HIT] == 1);
          CHECK(result.counts[COUNT_CAMERA_DEPTH_LIMIT] == 0);
        });
      }
}

TEST_CASE("through a hole the camera has hit nothing") {
  MaterialDescription gone = white();
  gone.opacity = 0;
  for (const char* integrator : {"whitted", "path"}) {
    SceneDescription scene = behind_disks(integrator, 8, 3, gone);
    scene.objects.erase(scene.objects.begin());
    on_picture_devices([&](const DeviceInfo& device) {
      const RenderResult result = scenes::render_on(device, scene);
      CHECK(result.image.data[3] == 0);
      CHECK(result.counts[COUNT_PRIMARY_HIT] == 0);
    });
  }
}

TEST_CASE(
    "max_depth ends whitted's camera rays on their way straight through panes, and counts them; not paths") {
  MaterialDescription pane;
  pane.diffuse = pane.ambient = pane.specular = dvec3(0);
  pane.transmission = dvec3(0.9);
  for (const char* integrator : {"whitted", "path"})
    for (const int count : {3, 12}) {
      const SceneDescription scene = behind_disks(integrator, 8, count, pane);
      on_picture_devices([&](const DeviceInfo& device) {
        INFO(integrator << ", panes " << count);
        const RenderResult result = scenes::render_on(device, scene);
        const bool ended = count > 8 && scene.render.integrator == "whitted";
        CHECK(result.counts[COUNT_CAMERA_DEPTH_LIMIT] == (ended ? 1 : 0));
        CHECK((result.image.data[0] > 0) != ended);
      });
    }
}
