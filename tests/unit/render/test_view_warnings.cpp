// Views that floats, or a device without doubles, cannot show well are reported with the mend.
#include "catch.h"
#include "render/device/view_warnings.h"
#include "scene_text.h"

using namespace sundog;

namespace {

SceneDescription ball_seen_from(double distance, double fov) {
  SceneDescription scene =
      load_scene_text(scene_of(R"({"type": "formula", "distance": "length(p) - 1", "material": "m"})"));
  scene.camera.position = {0, 0, 1 + distance};
  scene.camera.target = {0, 0, 0};
  scene.camera.fov = fov;
  return scene;
}

}  // namespace

TEST_CASE("a near view of a field is reported for devices without doubles, a narrow one for all") {
  DeviceInfo plain, fine;
  plain.platform_name = "plain";
  fine.extensions = "cl_khr_icd cl_khr_fp64";
  const std::vector<DeviceInfo> devices{plain, fine};
  const auto found = [&](double distance, double fov) {
    return view_warnings(compile(ball_seen_from(distance, fov)), devices);
  };
  CHECK(found(2, 40).empty());
  const auto near = found(1e-8, 40);
  REQUIRE(near.size() == 1);
  CHECK(near[0].find("plain") != std::string::npos);
  CHECK(near[0].find("choose another device") != std::string::npos);
  const auto narrow = found(2, 1e-6);
  REQUIRE(narrow.size() >= 1);
  CHECK(narrow[0].find("raise fov") != std::string::npos);
}
