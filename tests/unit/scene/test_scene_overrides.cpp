// --set: one value of a scene, changed from outside.
#include <string>

#include "catch.h"
#include "scene/load.h"
#include "scene_text.h"

using namespace sundog;

namespace {

const std::string scene = R"({
  "camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 40},
  "lights": [{"type": "ambient"}, {"type": "point", "position": [1, 2, 3]}],
  "materials": {"glass": {"type": "dielectric", "ior": 1.5}, "a/b~c": {}},
  "objects": [{"type": "sphere", "material": "glass"}]})";

SceneDescription with(const std::vector<std::string>& overrides) { return load_scene_text(scene, overrides); }

void check_error(const std::string& setting, const std::string& place, const std::string& words) {
  const SceneError error = error_of(scene, {setting});
  INFO(error.what());
  CHECK(error.place == place);
  CHECK(error.reason.find(words) != std::string::npos);
  CHECK(error.reason.find("the setting " + setting) != std::string::npos);
}

}  // namespace

TEST_CASE("an override changes a value that is there") {
  CHECK(with({"/camera/fov=30"}).camera.fov == 30);
  CHECK(with({"/camera/position=[1, 2, 3]"}).camera.position == dvec3(1, 2, 3));
  CHECK(with({"/camera/position/2=7.5"}).camera.position == dvec3(0, 0, 7.5));
  CHECK(with({"/lights/1/position/0=-4"}).lights[1].position == dvec3(-4, 2, 3));
  CHECK(with({"/materials/glass/ior=1.7"}).media[1].ior == 1.7);
  CHECK(with({"/objects=[]"}).objects.empty());
}

TEST_CASE("an override adds a value that the format knows, and the section around it") {
  CHECK(with({"/render/samples=16"}).render.samples == 16);
  CHECK(with({"/image/width=17", "/image/height=18"}).image.height == 18);
  CHECK(with({"/lights/0/intensity=3"}).lights[0].intensity == 3);
  CHECK(with({"/materials/glass/specular/exponent=99"}).materials[1].exponent == 99);
  CHECK(with({"/lights/-={\"type\": \"ambient\"}"}).lights.size() == 3);
}

TEST_CASE("a later override sees what an earlier one did") {
  CHECK(with({"/camera/fov=30", "/camera/fov=20"}).camera.fov == 20);
  CHECK(with({"/media/ice={\"ior\": 1.3}", "/media/ice/ior=1.4"}).media[1].ior == 1.4);
}

TEST_CASE("an override's value is JSON, or else a string") {
  CHECK(with({"/render/tracer=wide"}).render.tracer == Tracer::wide);
  CHECK(with({"/render/tracer=\"wide\""}).render.tracer == Tracer::wide);
  CHECK(with({"/objects/0/name=a=b"}).objects[0].name == "a=b");
  check_error("/camera/fov=wide", "/camera/fov", "wanted a number, found the string \"wide\"");
  check_error("/camera/fov=1e999", "/camera/fov", "wanted a number");
  check_error("/camera/fov=", "/camera/fov", "wanted a number, found an empty string");
  check_error("/camera/fov=\xff", "/camera/fov", "wanted a number, found the string \"\xEF\xBF\xBD\"");
  const SceneError last = error_of(scene, {"/camera/fov=30", "/camera/fov=wide"});
  CHECK_THAT(last.reason, ContainsSubstring("(changed by the setting /camera/fov=wide)"));
  const SceneError added = error_of(scene, {R"(/lights/-={"type": "lamp"})"});
  CHECK_THAT(added.reason, ContainsSubstring("(changed by the setting /lights/-="));
}

TEST_CASE("overrides append in turn, and an error names the one at fault") {
  const std::string ambient = R"(/lights/-={"type": "ambient"})", wrong = R"(/lights/-={"type": "lamp"})";
  CHECK(with({ambient, ambient}).lights.size() == 4);
  CHECK_THAT(error_of(scene, {wrong, ambient}).reason, ContainsSubstring("(changed by the setting " + wrong));
}

TEST_CASE("an override may set a part of an array that is the default") {
  CHECK(glm::distance(with({"/camera/up/2=1"}).camera.up, glm::normalize(dvec3(0, 1, 1))) < 1e-12);
  const auto objects = [](const std::string& setting) {
    return with(
               {R"(/objects/-={"type": "group", "objects": [{"type": "group", "material": "glass", "objects": [
      {"type": "sphere", "name": "inner"}, {"type": "sphere", "name": "outer"}]}]})",
                setting})
        .objects;
  };
  const auto center = [&](const std::string& setting) {
    return dvec3(objects(setting).back().world_from_object[3]);
  };
  CHECK(center("/objects/outer/center/1=3") == dvec3(0, 3, 0));
  CHECK(center("/objects/outer/center=[1, 2, 3]") == dvec3(1, 2, 3));
  CHECK_THROWS_AS(objects("/objects/nobody/center=[1, 2, 3]"), SceneError);
  check_error("/camera/moves_to/1=3", "/camera/moves_to", "there is no /camera/moves_to");
}

TEST_CASE("escapes lead an override to keys with / and ~") {
  CHECK(with({"/materials/a~1b~0c/vertex_color=true"}).materials[0].vertex_color);
}

TEST_CASE("an override that is checked like the file names its place and itself") {
  check_error("/camera/fov=200", "/camera/fov", "above 0 and below 180");
  check_error("/camera/fovv=30", "/camera/fovv", "did you mean \"fov\"?");
  check_error("/rendr/samples=3", "/rendr", "did you mean \"render\"?");
  check_error("/camera/target=[0, 0, 5]", "/camera", "same point");
}

TEST_CASE("an override that leads nowhere names its place") {
  check_error("/camera/fov/x=3", "/camera/fov/x", "leads nowhere: /camera/fov holds a single value");
  check_error("/lights/2/intensity=3", "/lights/2", "leads nowhere: /lights has 2 items");
  check_error("/lights/01/intensity=3", "/lights/01", "leads nowhere");
  check_error("/lights/-1=3", "/lights/-1", "leads nowhere");
  check_error("/lights/one/intensity=3", "/lights/one", "leads nowhere");
  check_error("/materials/galss/ior=3", "/materials/galss", "did you mean \"glass\"?");
  check_error("/meshes/a/file=x", "/meshes/a", "leads nowhere: there is no /meshes/a");
  check_error("/render/0/x=1", "/render", "leads nowhere: there is no /render");
}

TEST_CASE("text that is no override is a usage error") {
  for (const char* setting : {"", "=", "/", "=3", "/=3", "camera/fov=3", "/camera/fov", "/a~2=3", "/a~=3"}) {
    INFO(setting);
    CHECK_THROWS_AS(with({setting}), UsageError);
  }
}

TEST_CASE("overrides change what is made up around a model") {
  const TemporaryFolder folder;
  const auto file = folder.write("tetra.ply", tetrahedron_ply);
  const SceneDescription plain = load_scene(file);
  const SceneDescription changed = load_scene(
      file, {"/camera/fov=10", "/image/width=64", "/image/height=48", "/image/background=[1, 0, 0]",
             "/lights/0/intensity=7", "/camera/position/1=50", "/render/max_depth=2"});
  CHECK(plain.camera.fov == 45);
  CHECK(changed.camera.fov == 10);
  CHECK(changed.camera.position == dvec3(plain.camera.position.x, 50, plain.camera.position.z));
  CHECK(changed.image.width == 64);
  CHECK(changed.image.background_top == dvec3(1, 0, 0));
  CHECK(changed.lights[0].intensity == 7);
  CHECK(changed.render.max_depth == 2);
  try {
    load_scene(file, {"/camera/fov=0"});
    FAIL("no error");
  } catch (const SceneError& error) {
    CHECK(error.file == file.string());
    CHECK(error.place == "/camera/fov");
  }
}

TEST_CASE("a made-up camera fits the image that overrides ask for") {
  const TemporaryFolder folder;
  const auto file = folder.write("tetra.ply", tetrahedron_ply);
  const auto distance = [&](const std::vector<std::string>& overrides) {
    const Camera camera = load_scene(file, overrides).camera;
    return glm::length(camera.position - camera.target);
  };
  const double plain = distance({});
  CHECK(distance({"/image/width=100", "/image/height=400"}) > 1.5 * plain);
  CHECK(distance({"/image/width=1280", "/image/height=960"}) == plain);
  CHECK_THROWS_AS(distance({"/image/width=none"}), SceneError);
  CHECK_THROWS_AS(distance({"/image=3"}), SceneError);
  CHECK_THROWS_AS(distance({"/image/width=-5"}), SceneError);
}
