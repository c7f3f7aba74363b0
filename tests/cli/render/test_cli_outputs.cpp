// No output takes the place of a file that is read, be it named by the scene, by a model of the scene, or
// reached by a link.
#include <base/file.h>
#include <base/image_io.h>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

/// A scene that reads a texture, an environment, a model with its materials and their texture, and a glTF
/// with its buffer.
struct ReadingFolder : CliFolder {
  ReadingFolder() {
    const Image grey(2, 2, 3);
    for (const char* name : {"texture.png", "sky.hdr", "mapped.png"}) write_image(grey, *this / name);
    write("shape.mtl", "newmtl a\nmap_Kd mapped.png\n");
    write("shape.obj", "mtllib shape.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    write("shape.bin", std::string(36, '\0').replace(14, 2, "\x80\x3f").replace(30, 2, "\x80\x3f"));
    write("shape.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "buffers": [{"uri": "shape.bin", "byteLength": 36}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]})");
    scene =
        write(
            "reading.json",
            R"({"image": {"width": 16, "height": 12, "background": [0, 0, 0]}, "lights": [{"type": "ambient"}],
      "environment": {"type": "image", "file": "sky.hdr"},
      "textures": {"t": {"type": "image", "file": "texture.png"}},
      "materials": {"m": {"color": "t"}},
      "objects": [{"type": "sphere", "material": "m"}, {"type": "model", "file": "shape.obj"},
                  {"type": "model", "file": "shape.gltf"}]})")
            .string();
  }
};

/// The file is as it was, and the command says which name is to be changed.
void check_refused(const ReadingFolder& folder, const std::vector<std::string>& command,
                   const std::string& name) {
  const std::string before = read_file(folder / name);
  const CommandResult result = run_sundog(command);
  CAPTURE(command, result.err);
  CHECK(result.status == 2);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find("is read, and would be written over") != std::string::npos);
  CHECK(read_file(folder / name) == before);
}

}  // namespace

TEST_CASE("no output of render takes the place of a file that the scene names, or its models do") {
  const ReadingFolder folder;
  for (const char* name : {"texture.png", "sky.hdr", "mapped.png"})
    check_refused(folder, {"render", folder.scene, "-o", folder.file(name)}, name);
  const std::string out = folder.file("out.png");
  for (const char* name : {"shape.mtl", "shape.obj", "shape.bin", "shape.gltf", "reading.json"}) {
    check_refused(folder, {"render", folder.scene, "-o", out, "--stats", folder.file(name)}, name);
    check_refused(folder, {"render", folder.scene, "-o", out, "--resume", folder.file(name)}, name);
  }
  check_refused(folder, {"render", folder.file("shape.gltf"), "-o", out, "--stats", folder.file("shape.bin")},
                "shape.bin");
  CHECK_FALSE(fs::exists(out));
}

TEST_CASE("textures that nothing uses are kept as well, those of a glTF too") {
  const ReadingFolder folder;
  std::string model = read_file(folder / "shape.gltf");
  folder.write("shape.gltf", model.insert(1, R"("images": [{"uri": "mapped.png"}], )"));
  check_refused(folder, {"render", folder.file("shape.gltf"), "-o", folder.file("mapped.png")}, "mapped.png");
  std::string text = read_file(folder.scene);
  write_file(folder.scene, text.replace(text.find(R"("color": "t")"), 12, R"("ior": 1)"));
  check_refused(folder, {"render", folder.scene, "-o", folder.file("texture.png")}, "texture.png");
}

TEST_CASE("links to a file that is read count as that file") {
  const ReadingFolder folder;
  fs::create_symlink("texture.png", folder / "soft.png");
  fs::create_hard_link(folder / "mapped.png", folder / "hard.png");
  check_refused(folder, {"render", folder.scene, "-o", folder.file("soft.png")}, "texture.png");
  check_refused(folder, {"render", folder.scene, "-o", folder.file("hard.png")}, "mapped.png");
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("soft.png")})
            .err.find("is a link to " + folder.file("texture.png")) != std::string::npos);
  fs::create_hard_link(folder / "reading.json", folder / "again.json");
  check_refused(folder,
                {"render", folder.scene, "-o", folder.file("o.png"), "--stats", folder.file("again.json")},
                "again.json");
}

TEST_CASE("an animation whose last frame would overwrite a texture is refused before the first is rendered") {
  const ReadingFolder folder;
  fs::rename(folder / "texture.png", folder / "t_0003.png");
  write_file(folder.scene, [&] {
    std::string text = read_file(folder.scene);
    text.replace(text.find("texture.png"), 11, "t_0003.png");
    return text.insert(1, R"("animate": [{"type": "linear", "value": "/image/background/0",
      "keys": [{"frame": 1, "value": 0}, {"frame": 3, "value": 1}]}], )");
  }());
  check_refused(folder, {"render", folder.scene, "--frames", "1..3", "-o", folder.file("t.png")},
                "t_0003.png");
  CHECK_FALSE(fs::exists(folder / "t_0001.png"));
}

TEST_CASE("no output of bake, halo, gallery, bench or compare takes the place of a file that is read") {
  const ReadingFolder folder;
  check_refused(folder,
                {"bench", "threads", folder.scene, "--repeat", "1", "--json", folder.file("shape.bin")},
                "shape.bin");
  check_refused(folder, {"bake", folder.scene, folder.file("shape.obj"), "-o", folder.file("texture.png")},
                "texture.png");
  check_refused(folder, {"gallery", folder.path().string(), folder.scene, folder.file("texture.json")},
                "texture.png");
  fs::create_symlink("sky.hdr", folder / "difference.hdr");
  check_refused(
      folder,
      {"compare", folder.file("sky.hdr"), folder.file("sky.hdr"), "--diff", folder.file("difference.hdr")},
      "sky.hdr");
  folder.write(
      "halo.json",
      R"({"environment": {"type": "halo", "crystals": [{"shape": "plate"}]}, "objects": [{"type": "model", "file": "shape.obj"}]})");
  check_refused(folder, {"halo", folder.file("halo.json"), "-o", folder.file("mapped.png")}, "mapped.png");
}

TEST_CASE("a SOURCE_DATE_EPOCH that is no time is refused before the render") {
  const CliFolder folder;
  for (const char* text : {"99999999999999999999", "253402300800", "-1", "1.5", "today"}) {
    CommandOptions options;
    options.environment = {{"SOURCE_DATE_EPOCH", text}};
    const CommandResult result =
        run_sundog({"render", folder.scene, "--metadata", "-o", folder.file("a.png"), "-q"}, options);
    CAPTURE(text, result.err);
    CHECK(result.status == 2);
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.find("SOURCE_DATE_EPOCH=" + std::string(text)) != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "a.png"));
  }
}

TEST_CASE("a SUNDOG_CHECKPOINT_EVERY that is no number of seconds is refused before the render") {
  const CliFolder folder;
  const std::string text = GENERATE("often", "10m", "-1", "nan");
  CommandOptions options;
  options.environment = {{"SUNDOG_CHECKPOINT_EVERY", text}};
  const CommandResult result = run_sundog(
      {"render", folder.scene, "-o", folder.file("a.png"), "--resume", folder.file("c"), "-q"}, options);
  CHECK(result.status == 2);
  CHECK(result.err == "sundog: SUNDOG_CHECKPOINT_EVERY " + text + ": wanted a number from 0 to 1000000000\n");
  CHECK_FALSE(fs::exists(folder / "a.png"));
}
