// Values of a scene keyed over frames.
#include <fmt/format.h>

#include "catch.h"
#include "scene/load.h"
#include "scene_text.h"

using namespace sundog;
using glm::dvec3;

namespace {

SceneDescription frame_of(const std::string& tracks, double frame) {
  const TemporaryFolder folder;
  folder.write("scene.json",
               fmt::format(R"({{"camera": {{"position": [0, 0, 4], "target": [0, 0, 0], "fov": 20}},
    "lights": [{{"type": "directional", "direction": [0, -1, 0]}}], "objects": [], "animate": [{}]}})",
                           tracks));
  return load_scene(folder.path() / "scene.json", {}, {.frame = frame});
}

SceneError frame_error(const std::string& tracks) {
  try {
    frame_of(tracks, 1);
  } catch (const SceneError& error) {
    return error;
  }
  FAIL("no error");
  throw;
}

std::string fov_track(const std::string& type) {
  return fmt::format(R"({{"type": "{}", "value": "/camera/fov", "keys": [
    {{"frame": 0, "value": 20}}, {{"frame": 10, "value": 40}}, {{"frame": 20, "value": 100}}]}})",
                     type);
}

}  // namespace

TEST_CASE("a linear track goes straight from key to key and stands still outside of them") {
  CHECK(frame_of(fov_track("linear"), -5).camera.fov == 20);
  CHECK(frame_of(fov_track("linear"), 5).camera.fov == Approx(30));
  CHECK(frame_of(fov_track("linear"), 10).camera.fov == 40);
  CHECK(frame_of(fov_track("linear"), 15).camera.fov == Approx(70));
  CHECK(frame_of(fov_track("linear"), 99).camera.fov == 100);
}

TEST_CASE("a smooth track goes through its keys without a kink") {
  const auto fov = [](double frame) { return frame_of(fov_track("smooth"), frame).camera.fov; };
  CHECK(fov(0) == Approx(20));
  CHECK(fov(10) == Approx(40));
  CHECK(fov(20) == Approx(100));
  const double h = 1e-3;
  CHECK((fov(10) - fov(10 - h)) / h == Approx(4).epsilon(1e-3));  // the slope through both neighbours
  CHECK((fov(10 + h) - fov(10)) / h == Approx(4).epsilon(1e-3));
  CHECK(fov(h) - fov(0) < 1e-4);
}

TEST_CASE("a rotate track turns a point about an axis from where it stands") {
  const std::string turn =
      R"({"type": "rotate", "value": "/camera/position", "center": [0, 0, 1], "degrees": 180, "first": 10, "last": 20})";
  const dvec3 start = frame_of(turn, 0).camera.position, half = frame_of(turn, 15).camera.position,
              end = frame_of(turn, 30).camera.position;
  CHECK(glm::distance(start, dvec3(0, 0, 4)) < 1e-12);
  CHECK(glm::distance(half, dvec3(3, 0, 1)) < 1e-12);
  CHECK(glm::distance(end, dvec3(0, 0, -2)) < 1e-12);
}

TEST_CASE("a track's errors name the track") {
  const std::string keys = R"("keys": [{"frame": 0, "value": 1}])";
  CHECK(frame_error(R"({"type": "linear", "value": "/camera/fob", )" + keys + "}").place == "/camera/fob");
  CHECK(frame_error(R"({"type": "linear", "value": "/lights/7/intensity", )" + keys + "}").place ==
        "/animate/0");
  CHECK(frame_error(R"({"type": "linear", "value": "/animate/0", )" + keys + "}").place ==
        "/animate/0/value");
  CHECK(frame_error(R"({"type": "rotate", "value": "/camera/fov", "last": 3})").place == "/animate/0");
  CHECK(frame_error(R"({"type": "smooth", "value": "/camera/fov", "keys": [{"frame": 1, "value": 1},
    {"frame": 1, "value": 2}]})")
            .place == "/animate/0/keys/1");
  CHECK(frame_error(R"({"type": "smooth", "value": "/camera/fov", "keys": []})").place == "/animate/0/keys");
}
