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

TEST_CASE("tracks move members of groups, and parts of arrays that are defaults") {
  const TemporaryFolder folder;
  const auto file = folder.write("scene.json", R"({"objects": [{"type": "group", "objects": [
      {"type": "sphere", "name": "inner", "material": "m"}]}], "materials": {"m": {}},
    "camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
    "animate": [
      {"type": "linear", "value": "/objects/inner/center/0", "keys": [{"frame": 0, "value": 1}, {"frame": 2, "value": 3}]},
      {"type": "rotate", "value": "/camera/up", "first": 0, "last": 2, "degrees": 180, "axis": [0, 0, 1]}]})");
  const SceneDescription scene = load_scene(file, {}, {.frame = 1});
  CHECK(dvec3(scene.objects.at(0).world_from_object[3]) == dvec3(2, 0, 0));
  CHECK(glm::length(scene.camera.up - dvec3(-1, 0, 0)) < 1e-12);
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

TEST_CASE("a smooth track never leaves the values of two neighbouring keys") {
  const auto fov = [](double frame) {
    return frame_of(R"({"type": "smooth", "value": "/camera/fov", "keys": [{"frame": 0, "value": 10},
      {"frame": 10, "value": 10}, {"frame": 12, "value": 40}, {"frame": 22, "value": 40}, {"frame": 23, "value": 30}]})",
                    frame)
        .camera.fov;
  };
  for (double frame = 0; frame <= 10; frame += 0.5) CHECK(fov(frame) == 10);
  for (double frame = 12; frame <= 22; frame += 0.5) CHECK(fov(frame) == 40);
  for (double frame = 10; frame < 12; frame += 0.125) CHECK(fov(frame + 0.125) > fov(frame));
  CHECK(fov(22.5) < 40);
}

TEST_CASE("a cycle begins again after its last key, without a hitch") {
  const std::string keys = R"(, "cycle": true, "keys": [{"frame": 0, "value": 30}, {"frame": 12, "value": 50},
    {"frame": 36, "value": 10}, {"frame": 48, "value": 30}]})";
  const auto fov = [&](const char* type, double frame) {
    return frame_of(fmt::format(R"({{"type": "{}", "value": "/camera/fov")", type) + keys, frame).camera.fov;
  };
  for (const char* type : {"step", "linear", "smooth", "bezier"}) {
    CAPTURE(type);
    CHECK(fov(type, 55) == Approx(fov(type, 7)));
    CHECK(fov(type, -5) == Approx(fov(type, 43)));
    CHECK(fov(type, 48) == 30);
  }
  const double h = 1e-3;
  CHECK((fov("smooth", 48 + h) - fov("smooth", 48)) / h ==
        Approx((fov("smooth", 48) - fov("smooth", 48 - h)) / h).epsilon(1e-3));
  CHECK(fov("smooth", 48 + h) - fov("smooth", 48) > h);
  const std::string turn =
      R"({"type": "rotate", "value": "/camera/position", "degrees": 360, "last": 20, "cycle": true})";
  CHECK(glm::distance(frame_of(turn, 25).camera.position, frame_of(turn, 5).camera.position) < 1e-12);
}

TEST_CASE("a step track, texts and booleans stay as they are until the next key") {
  CHECK(frame_of(fov_track("step"), 9.9).camera.fov == 20);
  CHECK(frame_of(fov_track("step"), 10).camera.fov == 40);
  CHECK(frame_of(fov_track("step"), 30).camera.fov == 100);
  const std::string sampler = R"({"type": "linear", "value": "/render/sampler", "keys": [
    {"frame": 0, "value": "sobol"}, {"frame": 4, "value": "independent"}]})";
  CHECK(frame_of(sampler, 3).render.sampler == SAMPLER_SOBOL);
  CHECK(frame_of(sampler, 4).render.sampler == SAMPLER_INDEPENDENT);
  const std::string splits = R"({"type": "step", "value": "/render/spatial_splits", "keys": [
    {"frame": 0, "value": true}, {"frame": 4, "value": false}]})";
  CHECK(frame_of(splits, 3).render.spatial_splits);
  CHECK_FALSE(frame_of(splits, 4).render.spatial_splits);
}

TEST_CASE("a bezier track goes by its handles, and without any as a smooth one") {
  const std::string eased = R"({"type": "bezier", "value": "/camera/fov", "keys": [
    {"frame": 0, "value": 20, "handle_right": {"frame": 4.2, "value": 20}},
    {"frame": 10, "value": 40, "handle_left": {"frame": 5.8, "value": 40}}]})";
  CHECK(frame_of(eased, 5).camera.fov == Approx(30));
  // CSS's cubic-bezier(0.42, 0, 0.58, 1), "ease-in-out": 0.1292 at a quarter of the time.
  CHECK((frame_of(eased, 2.5).camera.fov - 20) / 20 == Approx(0.1292).margin(5e-4));
  const std::string over = R"({"type": "bezier", "value": "/camera/fov", "keys": [
    {"frame": 0, "value": 20}, {"frame": 10, "value": 40, "handle_left": {"frame": 5, "value": 60}}]})";
  CHECK(frame_of(over, 8).camera.fov > 40);
  for (const double frame : {3.0, 12.5, 19.0})
    CHECK(frame_of(fov_track("bezier"), frame).camera.fov ==
          Approx(frame_of(fov_track("smooth"), frame).camera.fov));
}

TEST_CASE("a slerp track takes rotations the short way") {
  const auto turned = [](const char* second, double frame) {
    const TemporaryFolder folder;
    folder.write(
        "scene.json",
        fmt::format(R"({{"camera": {{"position": [0, 0, 4], "target": [0, 0, 0]}}, "materials": {{"m": {{}}}},
      "objects": [{{"type": "box", "material": "m", "transform": [{{"rotate": {{"quaternion": [0, 0, 0, 1]}}}}]}}],
      "animate": [{{"type": "slerp", "value": "/objects/0/transform/0/rotate/quaternion", "keys": [
        {{"frame": 0, "value": [0, 0, 0, 2]}}, {{"frame": 9, "value": {}}}]}}]}})",
                    second));
    return dvec3(
        load_scene(folder.path() / "scene.json", {}, {.frame = frame}).objects[0].world_from_object[0]);
  };
  const double h = std::sqrt(0.5), c = std::sqrt(0.75);
  const char *quarter = "[0, 1, 0, 1]", *other_way = "[0, 1, 0, -1]", *same = "[0, -1, 0, -1]";
  CHECK(glm::distance(turned(quarter, 9), dvec3(0, 0, -1)) < 1e-12);
  CHECK(glm::distance(turned(quarter, 3), dvec3(c, 0, -0.5)) < 1e-12);
  CHECK(glm::distance(turned(same, 3), dvec3(c, 0, -0.5)) < 1e-12);
  CHECK(glm::distance(turned(other_way, 4.5), dvec3(h, 0, h)) < 1e-12);
  CHECK(turned("[0, 0, 0, 1]", 4) == dvec3(1, 0, 0));
  for (const char* bad : {"[0, 1, 0]", "[0, 0, 0, 0]", "7"}) CHECK_THROWS_AS(turned(bad, 3), SceneError);
}

TEST_CASE("formulas read the clock of the frames, unless the name is theirs") {
  const TemporaryFolder folder;
  folder.write("scene.json", R"json({"camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
    "frames_per_second": 10, "materials": {"a": {"color": "wave"}, "b": {"color": "own"}, "c": {"color": "given"}},
    "textures": {"wave": {"type": "formula", "formula": "0.5 + 0.5 * sin(p.x + t)"},
      "own": {"type": "formula", "formula": ["t = p.x", "t * t"]},
      "given": {"type": "formula", "parameters": {"t": 7}, "formula": "t + p.x"}},
    "objects": [{"type": "formula", "material": "a", "distance": "length(p) - 1 - 0.1 * t"},
      {"type": "box", "material": "b"}, {"type": "box", "material": "c"}]})json");
  const auto clock = [](const std::vector<FormulaParameter>& all) {
    return all.empty() ? -1 : all.at(0).value.at(0);
  };
  SceneFrames frames(folder.path() / "scene.json", {}, {});
  for (const std::optional<double> frame : {std::optional(5.0), {}, {20.0}}) {
    const auto scene = frames.read(frame);
    const double seconds = frame.value_or(0) / 10;
    std::vector<double> found;
    for (const TextureDescription& texture : scene->textures)
      found.push_back(clock(texture.formula->parameters));
    CHECK(std::ranges::count(found, seconds) == 1);
    CHECK(std::ranges::count(found, -1) == 1);
    CHECK(std::ranges::count(found, 7) == 1);
    const FormulaStep& step = scene->fields.at(0).root.formula.steps.at(0);
    CHECK(clock(step.definition.parameters) == seconds);
    CHECK(step.values == std::vector{seconds});
  }
}

TEST_CASE("tracks call objects and lights by their names, and values by names with any sign in them") {
  const TemporaryFolder folder;
  folder.write("scene.json", R"({"camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
    "lights": [{"type": "ambient"}, {"type": "point", "name": "lamp", "position": [0, 4, 0]}],
    "materials": {"a=b/c": {"color": [0.5, 0.5, 0.5]}},
    "objects": [{"type": "sphere", "material": "a=b/c"},
      {"type": "group", "name": "pair", "objects": [{"type": "sphere", "name": "ball", "material": "a=b/c"}]}],
    "animate": [{"type": "linear", "value": "/lights/lamp/intensity", "keys": [{"frame": 0, "value": 7}]},
      {"type": "linear", "value": "/objects/pair/objects/ball/radius", "keys": [{"frame": 0, "value": 3}]},
      {"type": "linear", "value": "/materials/a=b~1c/color/0", "keys": [{"frame": 0, "value": 0.25}]}]})");
  const SceneDescription scene =
      load_scene(folder.path() / "scene.json",
                 {"/lights/lamp/position/1=9", "/materials/a=b~1c/color/1=0.75"}, {.frame = 0});
  CHECK(scene.lights[1].intensity == 7);
  CHECK(scene.lights[1].position.y == 9);
  CHECK(std::get<SphereShape>(scene.objects[1].shape).radius == 3);
  const dvec3 color = scene.materials[0].diffuse / scene.materials[0].diffuse.z;
  CHECK(color.x == Approx(0.5));
  CHECK(color.y == Approx(1.5));
}

TEST_CASE(
    "what would be lost is refused: two tracks with keys for one value, a setting that a track undoes") {
  const auto keyed = [](const char* pointer) {
    return fmt::format(R"({{"type": "step", "value": "{}", "keys": [{{"frame": 0, "value": 4}}]}})", pointer);
  };
  const std::string turn = R"({"type": "rotate", "value": "/camera/position", "last": 9})";
  CHECK(frame_error(keyed("/camera/fov") + "," + keyed("/camera/fov")).place == "/animate/1");
  CHECK(
      frame_error(keyed("/camera/position/0") + "," + keyed("/camera/fov") + "," + keyed("/camera/position"))
          .place == "/animate/2");
  CHECK(frame_error(turn + "," + keyed("/camera/position/1")).reason.find("before it") != std::string::npos);
  CHECK(frame_of(keyed("/camera/position/1") + "," + turn, 0).camera.position.y == 4);
  const auto with = [&](const char* setting, std::optional<double> frame) {
    const TemporaryFolder folder;
    folder.write("scene.json", R"({"camera": {"position": [0, 0, 4], "target": [0, 0, 0]}, "objects": [],
      "animate": [)" + keyed("/camera/position/0") +
                                   "," + turn + "]}");
    return load_scene(folder.path() / "scene.json", {setting}, {.frame = frame});
  };
  try {
    with("/camera/position/0=3", 0);
    FAIL("no error");
  } catch (const SettingError& error) {
    CHECK(error.place == "/animate/0");
    CHECK(error.reason.find("the setting /camera/position/0=3") != std::string::npos);
  }
  CHECK(with("/camera/position/0=3", std::nullopt).camera.position.x == 3);
  CHECK(with("/camera/position=[1, 2, 3]", 0).camera.position == dvec3(4, 2, 3));  // the rest of it counts
}

TEST_CASE("errors of a value that a track moves name the frame and the track") {
  const SceneError error =
      frame_error(R"({"type": "linear", "value": "/camera/fov", "keys": [{"frame": 0, "value": 20},
    {"frame": 2, "value": -40}]})");
  CHECK(error.place == "/camera/fov");
  CHECK(error.reason.find("(in frame 1, moved by /animate/0)") != std::string::npos);
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
  CHECK(frame_error(R"({"type": "step", "value": "/objects/ball/radius", )" + keys + "}")
            .reason.find("not one alone of that name") != std::string::npos);
  const auto bezier = [](const char* handle) {
    return fmt::format(R"({{"type": "bezier", "value": "/camera/fov", "keys": [
      {{"frame": 0, "value": 20, "handle_right": {}}}, {{"frame": 4, "value": 30}}]}})",
                       handle);
  };
  for (const char* handle :
       {R"({"frame": 5, "value": 20})", R"({"frame": -1, "value": 20})", R"({"frame": 2, "value": [1, 2]})"})
    CHECK(frame_error(bezier(handle)).place == "/animate/0/keys/0");
  CHECK(frame_error(R"({"type": "linear", "value": "/camera/fov", "keys": [{"frame": 0, "value": 20},
    {"frame": 4, "value": "wide"}]})")
            .place == "/animate/0/keys/1");
}

TEST_CASE("frames have seeds of their own unless the scene names one") {
  const std::string still = fov_track("linear");
  CHECK(frame_of(still, 0).render.seed == 0);
  CHECK(frame_of(still, 7).render.seed == 7);
  const TemporaryFolder folder;
  folder.write("scene.json",
               R"({"camera": {"position": [0, 0, 4], "target": [0, 0, 0]}, "objects": [], "animate": []})");
  const auto seed = [&](const std::vector<std::string>& settings, std::optional<double> frame) {
    return load_scene(folder.path() / "scene.json", settings, {.frame = frame}).render.seed;
  };
  CHECK(seed({"/render/seed=5"}, 7) == 5);
  CHECK(seed({"/render/seed=frame"}, 7) == 7);
  CHECK(seed({"/render/seed=frame"}, std::nullopt) == 0);
  CHECK(seed({}, std::nullopt) == 0);
}
