// Scenes, pictures and statistics through the standard streams, by the name "-".
#include <base/file.h>
#include <base/image_io.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

namespace {

using sundog::read_file;

/// A shell's line, with the program as $0 and `arguments` as $1 and so on.
CommandResult run_line(const std::string& line, const std::vector<std::string>& arguments,
                       const CommandOptions& options = {}) {
  std::vector<std::string> words = {"sh", "-c", line, SUNDOG_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_command(words, options);
}

/// Runs a command with a terminal as its standard streams.
CommandResult run_on_terminal(const std::string& line) {
  return run_command({"script", "-qec", line, "/dev/null"});
}

}  // namespace

TEST_CASE("-o - writes the file's bytes to the standard output, and nothing else") {
  const CliFolder folder;
  for (const std::string format : {"png", "jpg", "pfm", "exr"}) {
    const std::string file = folder.file("a." + format);
    REQUIRE(run_sundog({"render", folder.scene, "-o", file}).status == 0);
    std::vector<std::string> line = {"render", folder.scene, "-o", "-", "--verbose"};
    if (format != "png") line.insert(line.end(), {"--format", format});
    const CommandResult piped = run_sundog(line);
    CAPTURE(format, piped.err);
    CHECK(piped.status == 0);
    CHECK((piped.out == read_file(file)));
    CHECK(piped.err.find("32x24") != std::string::npos);  // the figures are on stderr
  }
  CHECK(run_sundog({"render", folder.scene, "-o", "-", "--quiet"}).err.empty());
}

TEST_CASE("a reader of warnings who has left costs no picture") {
  const CliFolder folder;
  folder.write("a.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  run_line(R"(("$0" render "$1" -o "$2" --size 8x8 --samples 1 2>&1 >/dev/null; echo $? >"$3") | :)",
           {folder.file("a.obj"), folder.file("a.png"), folder.file("status")});
  CHECK(read_file(folder.file("status")) == "0\n");
  CHECK(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("a JPEG holds the PNG's colours, nearly") {
  const CliFolder folder;
  for (const char* name : {"a.png", "a.jpg", "a.jpeg"})
    REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file(name)}).status == 0);
  CHECK((read_file(folder.file("a.jpg")) == read_file(folder.file("a.jpeg"))));
  CHECK(read_file(folder.file("a.jpg")).starts_with("\xff\xd8\xff"));
  const sundog::Image exact = sundog::read_image(folder.file("a.png"));
  const sundog::Image lossy = sundog::read_image(folder.file("a.jpg"));
  REQUIRE(lossy.data.size() == exact.data.size());
  double sum = 0;
  for (std::size_t i = 0; i < exact.data.size(); ++i) sum += std::abs(double{exact.data[i]} - lossy.data[i]);
  CHECK(sum / static_cast<double>(exact.data.size()) < 0.02);  // 0.011: glass edges
}

TEST_CASE("--stats - prints one JSON value, and nothing else") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--stats", "-", "--verbose"});
  CHECK(result.status == 0);
  const nlohmann::json stats = nlohmann::json::parse(result.out, nullptr, false);
  REQUIRE(stats.is_object());
  CHECK(stats.at("schema") == 1);
  CHECK(stats.at("image").at("width") == 32);
}

TEST_CASE("a picture is not written to a terminal, nor a scene read from one") {
  const CliFolder folder;
  const std::string sundog = SUNDOG_BINARY;
  const CommandResult picture = run_on_terminal(sundog + " render " + folder.scene + " -o -");
  CAPTURE(picture.out);
  CHECK(picture.status == 2);
  CHECK(picture.out.find("the standard output is a terminal") != std::string::npos);
  const CommandResult scene = run_on_terminal(sundog + " info - < /dev/tty");
  CAPTURE(scene.out);
  CHECK(scene.status == 2);
  CHECK(scene.out.find("found a terminal") != std::string::npos);
}

TEST_CASE("a picture that a closed pipe does not take is kept elsewhere") {
  const CliFolder folder;
  CommandOptions options;
  options.environment = {{"TMPDIR", folder.path().string()}};
  const CommandResult result =
      run_line("{ \"$0\" render \"$1\" -o - --quiet; echo $? >&2; } | true", {folder.scene}, options);
  CAPTURE(result.err);
  CHECK(result.err.find("the standard output cannot be written") != std::string::npos);
  CHECK(result.err.find("/image.png") != std::string::npos);
  CHECK(result.err.ends_with("1\n"));
}

TEST_CASE("a scene is read from the standard input, its files beside the current folder") {
  const CliFolder folder;
  folder.write("models/tetra.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string scene = folder
                                .write("placed.json", R"({"image": {"width": 16, "height": 16},
      "camera": {"position": [0, 1, 5], "target": [0, 0, 0]}, "lights": [{"type": "ambient"}],
      "meshes": {"tetra": {"file": "models/tetra.obj"}}, "materials": {"m": {"ambient": 1}},
      "objects": [{"type": "mesh", "mesh": "tetra", "material": "m"}]})")
                                .string();
  CommandOptions there;
  there.folder = folder.path();
  REQUIRE(run_sundog({"render", scene, "-o", folder.file("a.png")}).status == 0);
  for (const char* from : {"- -o b.png < \"$1\"", "- --isolate -o b.png < \"$1\"",
                           "/dev/stdin -o b.png < \"$1\"", "/dev/stdin --isolate -o b.png < \"$1\""}) {
    std::filesystem::remove(folder / "b.png");
    const CommandResult result = run_line(std::string("\"$0\" render ") + from, {scene}, there);
    CAPTURE(from, result.err);
    REQUIRE(result.status == 0);
    CHECK((read_file(folder.file("b.png")) == read_file(folder.file("a.png"))));
  }
  const CommandResult info = run_line("\"$0\" info - < \"$1\"", {scene}, there);
  CHECK(info.status == 0);
}

TEST_CASE("errors of a scene from the standard input say so") {
  const CliFolder folder;
  const CommandResult broken =
      run_line("echo '{\"objects\": [], \"camra\": 1}' | \"$0\" render - -o \"$1\"", {folder.file("a.png")});
  CAPTURE(broken.err);
  CHECK(broken.status == 3);
  CHECK(broken.err.starts_with("sundog: standard input: /camra: unknown key"));
  const CommandResult set = run_line("\"$0\" render - -o \"$2\" --set /camera/fov=190 < \"$1\"",
                                     {folder.scene, folder.file("a.png")});
  CAPTURE(set.err);
  CHECK(set.status == 2);
  const CommandResult empty = run_sundog({"render", "-", "-o", folder.file("a.png")});
  CHECK(empty.status == 3);
  CHECK(empty.err.find("standard input: wanted a JSON object, found an empty file") != std::string::npos);
}
