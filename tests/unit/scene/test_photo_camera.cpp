// The camera as photographers give it: focal length, film, f-number, and the object in focus.
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "catch.h"
#include "scene/document.h"
#include "scene/shot.h"
#include "scene_text.h"

using namespace sundog;
using nlohmann::json;

namespace {

Camera camera_of(const std::string& camera, const std::string& more = "") {
  return load_scene_text(
             scene_with(R"("image": {"width": 300, "height": 200}, "camera": {"position": [0, 0, 5],
      "target": [0, 0, 0], )" +
                        camera + "}" + more))
      .camera;
}

/// A plane, a ball 8 before the camera, and a group whose box reaches from z = -4 to z = 1.
json document_focused_on(const char* name) {
  json document = json::parse(R"({
    "camera": {"position": [0, 0, 5], "target": [0, 0, 0], "lens": {"radius": 0.1}},
    "materials": {"m": {}},
    "objects": [{"type": "plane", "name": "ground", "material": "m"},
      {"type": "sphere", "name": "ball", "center": [2, 1, -3], "material": "m"},
      {"type": "group", "name": "pair", "material": "m", "objects": [
        {"type": "sphere", "name": "left", "center": [0, 0, -3]}, {"type": "sphere", "center": [0, 0, 0]}]},
      {"type": "sphere", "name": "behind", "center": [0, 0, 9], "material": "m"}]})");
  document["camera"]["lens"]["focus_on"] = name;
  return document;
}

double focus_on(const char* name) {
  return *load_scene_document(document_focused_on(name), "scene.json", {}).camera.lens.focus;
}

}  // namespace

TEST_CASE("a focal length sees as much as the film has room for, whatever the picture's shape") {
  // 36 mm by 24 mm behind 50 mm.
  CHECK(camera_of(R"("focal_length": 50)").fov == Approx(2 * std::atan(12 / 50.0) * 180 / M_PI));
  CHECK(camera_of(R"("focal_length": 4, "film_width": 6)").fov == Approx(2 * std::atan(0.5) * 180 / M_PI));
  CHECK(camera_of(R"("film_width": 6)").fov == 45);
}

TEST_CASE("the aperture of an f-number is the focal length over it, in scene units") {
  CHECK(camera_of(R"("focal_length": 50, "lens": {"f_number": 2})", R"(, "unit": 1)").lens.radius ==
        Approx(0.0125));
  CHECK(camera_of(R"("focal_length": 50, "lens": {"f_number": 2})", R"(, "unit": 0.001)").lens.radius ==
        Approx(12.5));
  CHECK(camera_of(R"("focal_length": 50, "lens": {"f_number": 2})").lens.radius == Approx(0.125));
}

TEST_CASE("the camera focuses on the middle of an object or a group, by its depth") {
  CHECK(focus_on("ball") == Approx(8));
  CHECK(focus_on("left") == Approx(8));
  CHECK(focus_on("pair") == Approx(6.5));
  for (const auto& [name, reason] : {std::pair("ground", "no end"), std::pair("behind", "behind the camera"),
                                     std::pair("bell", "did you mean \"ball\"?")}) {
    try {
      focus_on(name);
      FAIL(name);
    } catch (const SceneError& error) {
      CHECK(error.place == "/camera/lens/focus_on");
      CHECK(std::string(error.what()).find(reason) != std::string::npos);
    }
  }
}

TEST_CASE("a viewer's camera that moves keeps its object in focus") {
  const json before = document_focused_on("ball");
  const SceneDescription scene = load_scene_document(before, "scene.json", {});
  json after = before;
  after["camera"]["position"] = {0, 0, 15};
  const auto changed = change_scene(scene, before, after, {});
  REQUIRE(changed);
  CHECK(changed->camera.lens.focus == Approx(18));
  after["camera"]["lens"]["focus_on"] = "left";
  CHECK(!change_scene(scene, before, after, {}));
}

TEST_CASE("an orthographic camera's file has its matrix: depth changes no place in the picture") {
  SceneDescription scene;
  scene.image.width = 300, scene.image.height = 200;
  scene.camera.position = {1, 2, 5};
  scene.camera.target = {1, 2, 0};
  scene.camera.orthographic = 4;
  const glm::dmat4 ndc = shot_of(scene).world_to_ndc;
  for (const double z : {0.0, -90.0}) {
    const glm::dvec4 corner = ndc * glm::dvec4(4, 0, z, 1);
    CHECK(corner.x / corner.w == Approx(1));
    CHECK(corner.y / corner.w == Approx(1));
  }
}
