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
    const SceneDescription scene = ball_seen_from(distance, fov);
    return view_warnings(scene, compile(scene), devices);
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

TEST_CASE("a view of a field from where doubles end is reported, and none from before that") {
  DeviceInfo fine;
  fine.extensions = "cl_khr_icd cl_khr_fp64";
  const std::vector<DeviceInfo> devices{fine};
  const auto found = [&](double distance) {
    const SceneDescription scene = ball_seen_from(distance, 40);
    return view_warnings(scene, compile(scene), devices);
  };
  CHECK(found(1e-10).empty());
  const auto ended = found(1e-13);
  REQUIRE(ended.size() == 1);
  CHECK(ended[0].find("move it back") != std::string::npos);
}

TEST_CASE("an object is named where rays leave it by more than a hundredth of its distance") {
  const auto found = [&](const std::string& object, double distance) {
    SceneDescription scene = load_scene_text(scene_of(object));
    scene.camera.position = {0.3 * distance, 0.5 * distance, distance};
    scene.camera.target = {0, 0, 0};
    return view_warnings(scene, compile(scene), {});
  };
  const std::string begin = R"({"name": "ground", "material": "m", )";
  const std::string ball = begin + R"("type": "sphere", "radius": 1000, "center": [0, -1000, 0]})";
  const std::string box = begin + R"("type": "box", "min": [-1e6, -2e6, -1e6], "max": [1e6, 0, 1e6]})";
  const std::string slab = begin + R"("type": "box", "min": [-1e6, -0.5, -1e6], "max": [1e6, 0, 1e6]})";
  const std::string disk = begin + R"("type": "disk", "radius": 1e6})";
  const std::string sky = begin + R"("type": "sphere", "radius": 1e6})";
  const std::string plane = begin + R"("type": "plane"})";
  CHECK(found(ball, 3).empty());
  const std::string nameless =
      R"({"type": "sphere", "radius": 1000, "center": [0, -1000, 0], "material": "m"})";
  CHECK(found(nameless, 0.03).at(0).find("/objects/0") != std::string::npos);
  CHECK(found(box, 1e3).empty());
  for (const std::string& harmless : {slab, disk, sky, plane}) CHECK(found(harmless, 3).empty());
  for (const auto& warnings : {found(ball, 0.03), found(box, 10)}) {
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("\"ground\"") != std::string::npos);
    CHECK(warnings[0].find("move the camera back") != std::string::npos);
  }
}
