// Files that a scene or a model names stay in its folder, unless that is allowed.
#include <base/error.h>
#include <base/input.h>
#include <scene/load.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

const std::string secret = "topsecret 1 2 3\n";
const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Folders "in" and "out"; the second one holds what must not be read.
struct Folders : TemporaryFolder {
  Folders() {
    write("in/good.bin", quad_bytes());
    write("in/good.obj", triangle);
    for (const char* name : {"out/s", "out/s.bin", "out/s.mtl", "out/s.obj"}) write(name, secret);
    fs::create_symlink(path() / "out/s.bin", path() / "in/link.bin");
    fs::create_symlink(path() / "out/s.mtl", path() / "in/link.mtl");
    fs::create_symlink(path() / "out/s.obj", path() / "in/link.obj");
    fs::create_symlink(path() / "out", path() / "in/way");
  }
};

/// The error of loading, with or without leave; "": none.
std::string error_of(const fs::path& file, bool outside) {
  try {
    load_scene(file, {}, {.outside_files = outside});
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

void check_refused(const fs::path& file, const std::string& named) {
  CAPTURE(file.filename(), named);
  const std::string error = error_of(file, false);
  CHECK_THAT(error, ContainsSubstring("leads out of the") && ContainsSubstring("allow outside files"));
  CHECK(error.find("topsecret") == std::string::npos);
}

std::string gltf_with(const std::string& uri) {
  return document(R"("buffers":[{"byteLength":72,"uri":)" + nlohmann::json(uri).dump() + "}]," + quad_views +
                  R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)" + one_node);
}

std::string scene_with(const std::string& file) {
  return R"({"objects":[{"type":"model","file":)" + nlohmann::json(file).dump() + "}]}";
}

}  // namespace

TEST_CASE("a glTF's buffers stay in its folder", "[models]") {
  const Folders folder;
  for (const std::string& uri :
       {std::string("../out/s.bin"), std::string("%2e%2e/out/s.bin"), std::string("..%2Fout%2Fs.bin"),
        std::string("way/s.bin"), std::string("link.bin"), std::string("good.bin%00/../../out/s.bin"),
        (folder / "out/s.bin").string(), std::string("/dev/zero"), std::string("../gone.bin"),
        std::string("./../in/../out/s.bin")})
    check_refused(folder.write("in/a.gltf", gltf_with(uri)), uri);
  CHECK_THAT(
      error_of(folder.write("in/a.gltf", gltf_with("file://" + (folder / "out/s.bin").string())), true),
      ContainsSubstring("is not at hand"));
  for (const std::string uri : {"good.bin", "./good.bin", "../in/good.bin", "good%2Ebin"})
    CHECK(error_of(folder.write("in/a.gltf", gltf_with(uri)), false).empty());
  folder.write("out/s.bin", quad_bytes());
  for (const std::string uri : {"../out/s.bin", "link.bin", "way/s.bin"})
    CHECK(error_of(folder.write("in/a.gltf", gltf_with(uri)), true).empty());
}

TEST_CASE("an OBJ's material libraries outside its folder are not read, with a warning", "[models]") {
  const Folders folder;
  for (const std::string& name :
       {std::string("../out/s.mtl"), std::string("..\\out\\s.mtl"), std::string("way/s.mtl"),
        std::string("link.mtl"), (folder / "out/s.mtl").string(), std::string("../out/s")}) {
    CAPTURE(name);
    const Model model = load_model(folder.write("in/a.obj", "mtllib " + name + "\n" + triangle));
    REQUIRE(model.warnings.size() == 1);
    CHECK_THAT(model.warnings[0], Catch::Matchers::StartsWith("line 1: the material library") &&
                                      ContainsSubstring("leads out of the model's folder and is not read"));
  }
  const fs::path both = folder.write("in/a.obj", "mtllib gone.mtl ../out/s.mtl\n" + triangle);
  CHECK(load_model(both).warnings.size() == 2);
  CHECK(load_model(both, {.outside_files = true}).warnings.size() == 1);
}

TEST_CASE("a scene's models stay in its folder, and theirs in their own", "[models]") {
  const Folders folder;
  for (const std::string& file :
       {std::string("../out/s.obj"), std::string("way/s.obj"), std::string("link.obj"),
        (folder / "out/s.obj").string(), std::string("../out/gone.obj")})
    check_refused(folder.write("in/a.json", scene_with(file)), file);
  const fs::path mesh =
      folder.write("in/m.json", R"({"materials":{"m":{}},"meshes":{"x":{"file":"../out/s.obj"}},
    "objects":[{"type":"mesh","mesh":"x","material":"m"}]})");
  check_refused(mesh, "a mesh");
  CHECK(error_of(folder.write("in/a.json", scene_with("good.obj")), false).empty());
  CHECK(error_of(folder.write("in/a.json", scene_with((folder / "in/good.obj").string())), false).empty());
  folder.write("out/good.obj", triangle);
  CHECK(error_of(folder.write("in/a.json", scene_with("../out/good.obj")), true).empty());
  folder.write("in/sub/b.gltf", gltf_with("../good.bin"));
  check_refused(folder.write("in/a.json", scene_with("sub/b.gltf")), "a model's own file");
  CHECK(error_of(folder / "in/a.json", true).empty());
}

TEST_CASE("a file that the user names may be a link, and one in the current folder needs no folder",
          "[models]") {
  const Folders folder;
  folder.write("out/s.obj", triangle);
  CHECK(error_of(folder / "in/link.obj", false).empty());
  const fs::path before = fs::current_path();
  fs::current_path(folder / "in");
  folder.write("in/a.json", scene_with("good.obj"));
  CHECK(error_of("a.json", false).empty());
  CHECK(error_of("good.obj", false).empty());
  folder.write("in/a.json", scene_with("../out/s.obj"));
  CHECK_THAT(error_of("a.json", false), ContainsSubstring("leads out of the scene's folder"));
  fs::current_path(before);
}

TEST_CASE("a file that is not there leads out of no folder, by a relative path too") {
  CHECK_FALSE(leads_outside("scene.json", "no such picture.png"));
  CHECK_FALSE(leads_outside("./scene.json", "./no such folder/picture.png"));
  CHECK(leads_outside("scene.json", "../no such picture.png"));
  CHECK(leads_outside("scene.json", "folder/../../no such picture.png"));
}
