// Scenes as documents that are changed in memory: the same scene as from the file, and the short way for the
// view alone.
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/image_io.h"
#include "base/pixels/preview.h"
#include "base/pixels/stored_image.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "render/film/hash.h"
#include "scene/document.h"
#include "temporary_folder.h"

using namespace sundog;
using nlohmann::json;

namespace {

const std::filesystem::path scenes = std::filesystem::path(SUNDOG_SOURCE_DIR) / "scenes";

std::uint64_t hash_of(const SceneDescription& scene) { return hash_scene(compile(scene)); }

}  // namespace

TEST_CASE("a scene's document is the scene of its file") {
  for (const char* name : {"mandelbulb.json", "spheres.json", "nested_glass.json"}) {
    INFO(name);
    const json document = read_scene_document(scenes / name);
    CHECK(hash_of(load_scene_document(document, scenes / name)) == hash_of(load_scene(scenes / name)));
  }
}

TEST_CASE("a model's document is the scene that is made up around it") {
  const TemporaryFolder folder;
  const auto model = folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  // Its tables have another order: the file's materials come first where the file is the scene.
  const SceneDescription made = load_scene_document(read_scene_document(model), model),
                         loaded = load_scene(model);
  CHECK(made.camera.position == loaded.camera.position);
  CHECK(made.lights.size() == loaded.lights.size());
  REQUIRE(made.objects.size() == loaded.objects.size());
  const auto material_of = [](const SceneDescription& scene, std::size_t object) {
    return scene.materials.at(static_cast<std::size_t>(scene.objects[object].material));
  };
  for (std::size_t i = 0; i < made.objects.size(); ++i) {
    CHECK(made.objects[i].world_from_object == loaded.objects[i].world_from_object);
    CHECK(material_of(made, i).diffuse == material_of(loaded, i).diffuse);
  }
  CHECK_THROWS_AS(read_scene_document(folder.write("text.txt", "x")), SceneError);
  CHECK_THROWS_AS(read_scene_document(folder / "none.json"), SceneError);
}

TEST_CASE("a change of lights is refused as the whole scene is, with more groups of lights than a film has") {
  const auto file = scenes / "spheres.json";
  const json before = read_scene_document(file);
  const SceneDescription scene = load_scene_document(before, file);
  json after = before;
  for (int i = 0; i < 17; ++i)
    after["lights"].push_back(
        {{"type", "point"}, {"position", {0, 9, 0}}, {"group", "g" + std::to_string(i)}});
  CHECK_THROWS_AS(load_scene_document(after, file), SceneError);
  CHECK_THROWS_AS(change_scene(scene, before, after), SceneError);
}

TEST_CASE("a change of the view alone gives the scene that reading everything gives") {
  const auto file = scenes / "spheres.json";
  const json before = read_scene_document(file);
  const SceneDescription scene = load_scene_document(before, file);
  json after = before;
  after["camera"]["position"] = {2, 1, -5};
  after["camera"]["lens"] = {{"radius", 0.1}};
  after["image"]["width"] = 64;
  after["render"] = {{"samples", 9}, {"filter", "tent"}};
  const auto changed = change_scene(scene, before, after);
  REQUIRE(changed);
  CHECK(hash_of(*changed) == hash_of(load_scene_document(after, file)));
  after.erase("image");
  after.erase("render");
  const auto shorter = change_scene(scene, before, after);
  REQUIRE(shorter);
  CHECK(hash_of(*shorter) == hash_of(load_scene_document(after, file)));
}

TEST_CASE("a change of lights that rays do not meet gives the scene that reading everything gives") {
  const auto file = scenes / "spheres.json";
  const json before = read_scene_document(file);
  const SceneDescription scene = load_scene_document(before, file);
  json brighter = before, dark = before, more = before, lamp = before;
  brighter["lights"][1]["intensity"] = 3;
  dark.erase("lights");
  more["lights"].push_back(
      {{"type", "disk"}, {"position", {0, 3, 0}}, {"direction", {0, -1, 0}}, {"hidden", true}});
  lamp["lights"].push_back({{"type", "sphere"}, {"position", {0, 3, 0}}});  // rays meet it
  for (const json& after : {brighter, dark, more, lamp}) {
    const auto changed = change_scene(scene, before, after);
    REQUIRE(changed);
    CHECK(hash_of(*changed) == hash_of(load_scene_document(after, file)));
  }
  const auto lit = change_scene(scene, before, lamp), unlit = change_scene(*lit, lamp, before);
  REQUIRE(unlit);
  CHECK(hash_of(*unlit) == hash_of(scene));
}

TEST_CASE(
    "a change of materials, media or textures reads no mesh, and gives the scene that reading all gives") {
  const TemporaryFolder folder;
  const std::string model = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
  folder.write("one.obj", "mtllib one.mtl\n" + model);
  folder.write("one.mtl", "newmtl a\nKd 0.1 0.2 0.3\nTf 0.5 0.5 0.5\nd 0.5\nNi 1.4\n");
  write_image(Image(4, 4, 3), folder / "dots.png");
  const auto file = folder / "scene.json";
  const json before = json::parse(R"({
    "camera": {"position": [0, 0, 5], "target": [0, 0, 0]},
    "media": {"glass": {"ior": 1.5, "absorption": [0.1, 0.2, 0.3]}},
    "textures": {"dots": {"type": "image", "file": "dots.png"}, "check": {"type": "checker"}},
    "materials": {"clear": {"type": "dielectric", "medium": "glass"}, "plain": {"color": "dots"},
                  "own": {"type": "dielectric", "ior": 1.3}},
    "meshes": {"one": {"file": "one.obj"}},
    "objects": [{"type": "mesh", "mesh": "one"}, {"type": "sphere", "radius": 0.5, "material": "clear"},
                {"type": "box", "half": [1, 1, 1], "material": "plain"}]
  })");
  const SceneDescription scene = load_scene_document(before, file);
  const auto edited = [&](const char* pointer, const json& value) {
    json after = before;
    after[json::json_pointer(pointer)] = value;
    return after;
  };
  const std::vector<json> edits = {edited("/materials/plain/color", {0.1, 0.7, 0.2}),
                                   edited("/materials/plain/color", "check"),
                                   edited("/materials/plain/color", "dots"),
                                   edited("/materials/own", {{"color", {1, 0, 0}}}),
                                   edited("/materials/clear/medium", "air"),
                                   edited("/media/glass/ior", 1.7),
                                   edited("/media/air", {{"ior", 1}}),
                                   edited("/textures/check/size", 2),
                                   edited("/world", {{"medium", "glass"}, {"fog", {{"density", 0.1}}}})};
  std::vector<std::uint64_t> wanted;
  for (const json& after : edits)
    wanted.push_back(
        after["materials"]["clear"]["medium"] == "air" ? 0 : hash_of(load_scene_document(after, file)));
  for (const char* name : {"one.obj", "one.mtl"}) std::filesystem::remove(folder / name);
  for (std::size_t i = 0; i < edits.size(); ++i) {
    INFO(edits[i].dump());
    if (wanted[i] == 0) {
      CHECK_THROWS_AS(change_scene(scene, before, edits[i]), SceneError);
      continue;
    }
    const auto changed = change_scene(scene, before, edits[i]);
    REQUIRE(changed);
    CHECK(hash_of(*changed) == wanted[i]);
    CHECK(changed->meshes[0].positions.span().data() == scene.meshes[0].positions.span().data());
  }
  CHECK_FALSE(change_scene(scene, before, edited("/materials/more", {{"color", {1, 0, 0}}})));
}

TEST_CASE("a model keeps an image that it shares with the document's textures when these change") {
  const TemporaryFolder folder;
  folder.write("one.obj",
               "mtllib one.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n"
               "f 1/1 2/2 3/3\n");
  folder.write("one.mtl", "newmtl a\nmap_Kd dots.png\n");
  write_image(Image(4, 4, 3), folder / "dots.png");
  const auto file = folder / "scene.json";
  const json before = json::parse(R"({
    "textures": {"dots": {"type": "image", "file": "dots.png"}}, "materials": {"plain": {"color": "dots"}},
    "objects": [{"type": "model", "file": "one.obj"}, {"type": "sphere", "material": "plain"}]})");
  const SceneDescription scene = load_scene_document(before, file);
  REQUIRE(scene.images.size() == 1);
  json after = before;
  after["materials"]["plain"]["color"] = {1, 0, 0};
  const auto changed = change_scene(scene, before, after);
  const auto shown = changed ? hash_of(*changed) : hash_of(load_scene_document(after, file));
  CHECK(shown == hash_of(load_scene_document(after, file)));
}

TEST_CASE("a change of what is placed, or of the names of materials, is left to reading everything") {
  const auto file = scenes / "spheres.json";
  const json before = read_scene_document(file);
  const SceneDescription scene = load_scene_document(before, file);
  json removed = before, added = before, unplaced = before;
  removed.erase("materials");
  added["meshes"] = json::object();
  unplaced["camera"] = {{"fov", 30}};
  for (const json& after : {removed, added, unplaced}) CHECK_FALSE(change_scene(scene, before, after));
  json wrong = before;
  wrong["camera"]["fov"] = 200;
  try {
    change_scene(scene, before, wrong);
    FAIL("an angle of 200 degrees was taken");
  } catch (const SceneError& error) {
    CHECK(error.place == "/camera/fov");
  }
}

TEST_CASE("another integrator gives the scene that reading everything gives, and reads models anew") {
  const auto file = scenes / "spheres.json";
  const json before = read_scene_document(file);
  json after = before;
  after["render"]["integrator"] = "path";
  const auto changed = change_scene(load_scene_document(before, file), before, after);
  REQUIRE(changed);
  CHECK(hash_of(*changed) == hash_of(load_scene_document(after, file)));
  const TemporaryFolder folder;
  const auto model = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const json of_model = read_scene_document(model);
  json whitted = of_model;
  whitted["render"]["integrator"] = "whitted";
  CHECK_FALSE(change_scene(load_scene_document(of_model, model), of_model, whitted));
}

TEST_CASE("a preview has the picture's size and nearly its colours") {
  Image image(40, 24, 4);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) {
      image.pixel(x, y)[0] = static_cast<float>(x) / 40;
      image.pixel(x, y)[1] = 2;  // brighter than white
      image.pixel(x, y)[2] = y < 12 ? -1.0f : std::numeric_limits<float>::quiet_NaN();
    }
  const StoredImage stored = decode_jpeg(encode_preview(image, 95));
  REQUIRE(stored.width == 40);
  REQUIRE(stored.height == 24);
  for (const int x : {0, 20, 39}) {
    const std::size_t at = static_cast<std::size_t>(stored.channels * (12 * 40 + x));
    const float red = srgb_from_linear(static_cast<float>(x) / 40) * 255;
    CHECK(std::abs(static_cast<float>(stored.data[at]) - red) < 12);
    CHECK(stored.data[at + 1] > 240);
    CHECK(stored.data[at + 2] < 16);
  }
}
