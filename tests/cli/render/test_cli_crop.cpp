// --crop: a rectangle of the picture, with the bits that its pixels have in the whole one.
#include <algorithm>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

Image render(const CliFolder& folder, const std::string& name, std::vector<std::string> options) {
  options.insert(options.begin(),
                 {"render", folder.scene, "-o", folder.file(name), "--quiet", "--device", "0:0"});
  const CommandResult result = run_sundog(options);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  return read_image(folder / name);
}

/// The values of the pixels that differ from those of `whole` at that place.
std::size_t differing(const Image& part, const Image& whole, int x0, int y0) {
  std::size_t count = 0;
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      count += !std::equal(part.pixel(x, y), part.pixel(x, y) + part.channels, whole.pixel(x0 + x, y0 + y));
  return count;
}

}  // namespace

TEST_CASE("a cropped picture has the bits of the whole one's pixels") {
  const CliFolder folder;
  const std::vector<std::vector<std::string>> kinds = {
      {"--samples", "3"},
      {"--integrator", "path", "--caustics", "--samples", "2"},
      {"--integrator", "path", "--samples", "4", "--time-limit", "1000"}};
  for (const auto& kind : kinds) {
    CAPTURE(kind);
    const Image whole = render(folder, "whole.pfm", kind);
    for (const auto& [x, y, size] :
         {std::tuple(0, 0, "5x3"), {9, 6, "14x11"}, {27, 20, "5x4"}, {0, 0, "32x24"}}) {
      CAPTURE(x, y, size);
      std::vector<std::string> options = kind;
      options.insert(options.end(), {"--crop", std::to_string(x) + "," + std::to_string(y) + "," + size});
      const Image part = render(folder, "part.pfm", options);
      CHECK(std::to_string(part.width) + "x" + std::to_string(part.height) == size);
      CHECK(differing(part, whole, x, y) == 0);
    }
  }
}

TEST_CASE("a cropped EXR that --write-every writes says where it lies, too") {
  // Killed as soon as there is a picture: only --write-every can have written it.
  const CliFolder folder;
  CommandOptions here;
  here.folder = folder.path();
  const char* script =
      "\"$0\" render \"$1\" -o so_far.exr --quiet --device 0:0 --set /render/progressive=true --samples "
      "65536 "
      "--write-every 0.01 --float --crop 9,6,14x11 &\n"
      "until [ -s so_far.exr ]; do sleep 0.02; done; kill -KILL $!; wait $!";
  run_command({"sh", "-c", script, SUNDOG_BINARY, folder.scene}, here);
  const Image shown = read_image(folder / "so_far.exr");
  CHECK(shown.width == 32);
  CHECK(shown.height == 24);
}

TEST_CASE("a cropped EXR says where it lies in the picture, AOVs too") {
  const CliFolder folder;
  const Image whole = render(folder, "whole.exr", {"--float", "--aov", "depth"});
  const Image shown = render(folder, "part.exr", {"--float", "--aov", "depth", "--crop", "9,6,14x11"});
  CHECK(shown.width == 32);  // the reader honours the display window
  CHECK(shown.height == 24);
  CHECK(std::equal(shown.pixel(9, 6), shown.pixel(23, 6), whole.pixel(9, 6)));
  CHECK(shown.pixel(8, 6)[0] == 0);
  const Image far = read_aovs(folder / "whole.exr").at("depth"),
              near = read_aovs(folder / "part.exr").at("depth");
  CHECK(std::equal(near.pixel(9, 16), near.pixel(23, 16), far.pixel(9, 16)));
  CHECK(near.pixel(8, 16)[0] == 0);
}

TEST_CASE("a region outside the picture, or none, is an error before the render") {
  const CliFolder folder;
  const auto error = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {"render", folder.scene, "-o", folder.file("a.png")};
    command.insert(command.end(), options.begin(), options.end());
    const CommandResult result = run_sundog(command);
    CHECK(result.status == 2);
    CHECK(is_one_error_line(result.err));
    return result.err;
  };
  CHECK(
      error({"--crop", "20,0,13x4"}).find("the region 20,0,13x4 is not within the picture of 32x24 pixels") !=
      std::string::npos);
  CHECK(error({"--crop", "3x4"}).find("--crop 3x4: wanted X,Y,WxH") != std::string::npos);
  CHECK(error({"--crop", "0,0,4x4", "--tiles", "1/2"}).find("leave --tiles out") != std::string::npos);
}
