// Steps after the render: --denoise, --metadata.
#include <algorithm>
#include <filesystem>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

const std::string fake_folder = std::filesystem::path(SUNDOG_FAKE_DRIVER).parent_path().string();

CommandResult render(const CliFolder& folder, const std::string& out, std::vector<std::string> more,
                     const std::string& library = fake_folder) {
  std::vector<std::string> arguments{"render", folder.scene, "-o", folder.file(out), "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  CommandOptions options;
  options.environment = {{"SUNDOG_OIDN", library}, {"SOURCE_DATE_EPOCH", "1000000000"}};
  return run_sundog(arguments, options);
}

std::string text_of(const ImageTexts& texts, const std::string& name) {
  for (const auto& [key, text] : texts)
    if (key == name) return text;
  return "no " + name;
}

}  // namespace

TEST_CASE(
    "--denoise hands colours, and albedo and normals that it has cleaned, to the library and takes its "
    "picture") {
  const CliFolder folder;
  REQUIRE(
      render(folder, "plain.exr", {"--float", "--aov", "denoise_albedo", "--aov", "denoise_normal"}).status ==
      0);
  REQUIRE(render(folder, "clean.exr", {"--float", "--denoise"}).status == 0);
  REQUIRE(render(folder, "worker.exr", {"--float", "--denoise", "--isolate"}).status == 0);
  const Image plain = read_image(folder / "plain.exr"), clean = read_image(folder / "clean.exr");
  const AovImages aovs = read_aovs(folder / "plain.exr");
  CHECK(read_aovs(folder / "clean.exr").empty());
  CHECK(read_image(folder / "worker.exr").data == clean.data);
  for (std::size_t i = 0; i < clean.data.size() / 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      REQUIRE(clean.data[4 * i + c] == plain.data[4 * i + c] + 2 * aovs.at("denoise_albedo").data[3 * i + c] +
                                           2 * aovs.at("denoise_normal").data[3 * i + c]);
    // Alpha too, as a grey picture.
    REQUIRE(clean.data[4 * i + 3] ==
            std::clamp(plain.data[4 * i + 3] + 2 * aovs.at("denoise_albedo").data[3 * i] +
                           2 * aovs.at("denoise_normal").data[3 * i],
                       0.0f, 1.0f));
  }
}

TEST_CASE("--denoise without its library says where to get it, before anything is rendered") {
  const CliFolder folder;
  const CommandResult result = render(folder, "a.png", {"--denoise"}, folder.file("none.so"));
  CHECK(result.status == 2);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find("none.so") != std::string::npos);
  CHECK(result.err.find("pip install") != std::string::npos);
  CHECK(render(folder, "a.png", {"--denoise"}, SUNDOG_FAKE_DRIVER).err.find("no Open Image Denoise") !=
        std::string::npos);
  CHECK(render(folder, "a.part", {"--denoise", "--tiles", "1/2"}).status == 2);
  CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
  const CommandResult bright = render(folder, "a.png", {"--denoise", "--set", "/lights/0/intensity=1e6"});
  CHECK(bright.status == 1);
  CHECK(bright.err.find("the fake denoiser fails") != std::string::npos);
}

TEST_CASE("--metadata says in a PNG and an EXR what the picture is of and what made it") {
  const CliFolder folder;
  for (const std::string name : {"a.png", "a.exr"}) {
    CAPTURE(name);
    REQUIRE(render(folder, name, {"--metadata", "--set", "/camera/fov=41"}).status == 0);
    const ImageTexts texts = read_texts(folder / name);
    const bool png = name == "a.png";
    CHECK(text_of(texts, png ? "Software" : "software").starts_with("sundog "));
    CHECK(text_of(texts, png ? "Source" : "scene") == folder.scene);
    CHECK(text_of(texts, png ? "Settings" : "settings").find("32x24 pixels, samples 1") == 0);
    CHECK(text_of(texts, png ? "Settings" : "settings").find("/camera/fov=41") != std::string::npos);
    CHECK(text_of(texts, png ? "Device" : "device").find('/') != std::string::npos);
    CHECK(text_of(texts, png ? "Creation Time" : "capDate") ==
          (png ? "2001-09-09T01:46:40Z" : "2001:09:09 01:46:40"));
    REQUIRE(render(folder, "plain" + name, {"--set", "/camera/fov=41"}).status == 0);
    CHECK(read_image(folder / name).data == read_image(folder / ("plain" + name)).data);
    CHECK(text_of(read_texts(folder / ("plain" + name)), png ? "Settings" : "settings").starts_with("no "));
  }
  CHECK(render(folder, "a.pfm", {"--metadata"}).status == 2);
}
