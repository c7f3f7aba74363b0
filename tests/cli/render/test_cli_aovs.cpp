// Every AOV of one render: what it holds, and what an EXR says of it.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"
#include "render/film/cryptomatte.h"

using namespace sundog;

namespace {

/// A box that fills the left half of the picture, a ball right of it, and a field behind.
constexpr const char* scene_text = R"({
  "camera": {"position": [0, 0, 10], "target": [0, 0, 0], "fov": 20},
  "image": {"width": 24, "height": 16},
  "lights": [{"type": "point", "position": [0, 3, 9]}],
  "materials": {"red": {"color": [1, 0, 0]}, "blue": {"color": [0, 0, 1]}},
  "objects": [
    {"type": "box", "name": "wall", "min": [-9, -9, -1], "max": [0.05, 9, 0], "material": "red"},
    {"type": "sphere", "name": "ball", "center": [1, 0, 0], "radius": 0.5, "material": "blue"},
    {"type": "fractal", "name": "bulb", "formula": "mandelbulb", "material": "blue",
     "transform": [{"scale": 0.4}, {"translate": [1.6, 1.2, 0]}]}
  ]
})";

const char* const every_name[] = {
    "rays",     "depth",          "normal",         "position",         "albedo", "object",
    "material", "denoise_albedo", "denoise_normal", "geometric_normal", "uv",     "march_steps",
    "samples",  "variance",       "crypto_object",  "crypto_material",  "motion"};

std::string text_with(const ImageTexts& texts, const std::string& end, const std::string& part) {
  for (const auto& [key, text] : texts)
    if (key.ends_with(end) && text.find(part) != std::string::npos) return text;
  return "";
}

}  // namespace

TEST_CASE("every AOV is in the EXR, object and material ids as Cryptomatte") {
  const CliFolder folder;
  const std::string scene = folder.write("aovs.json", scene_text).string();
  std::vector<std::string> command{
      "render", scene, "-o", folder.file("a.exr"), "--quiet", "--samples", "8", "--adaptive", "0.02"};
  for (const char* name : every_name) command.insert(command.end(), {"--aov", name});
  const CommandResult result = run_sundog(command);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  const AovImages aovs = read_aovs(folder / "a.exr");
  CHECK(aovs.size() == 21);
  const auto id = [](const char* name) { return std::bit_cast<float>(id_bits(name)); };
  // Left of the edge at x = 0.05, in the pixel that it goes through, and on the ball.
  const Image &objects = aovs.at("crypto_object00"), &materials = aovs.at("crypto_material00");
  CHECK(objects.pixel(3, 8)[0] == id("wall"));
  CHECK(objects.pixel(3, 8)[1] == 1);
  CHECK(objects.pixel(12, 1)[0] == id("wall"));
  CHECK(objects.pixel(12, 1)[1] == Approx(read_image(folder / "a.exr").pixel(12, 1)[3]).margin(1e-3));
  CHECK(objects.pixel(12, 1)[3] == 0);
  CHECK(materials.pixel(3, 8)[0] == id("red"));
  for (const char* layer : {"crypto_object00", "crypto_object01", "crypto_object02"})
    for (std::size_t i = 0; i < 24 * 16; ++i)
      for (std::size_t pair = 0; pair < 2; ++pair) {
        const float* found = &aovs.at(layer).data[4 * i + 2 * pair];
        REQUIRE((found[0] == id("wall") || found[0] == id("ball") || found[0] == id("bulb") ||
                 (found[0] == 0 && found[1] == 0)));
      }
  double balls = 0, bulbs = 0, steps = 0;
  for (std::size_t i = 0; i < 24 * 16; ++i)
    for (std::size_t pair = 0; pair < 2; ++pair) {
      balls += objects.data[4 * i + 2 * pair] == id("ball") ? double(objects.data[4 * i + 2 * pair + 1]) : 0;
      bulbs += objects.data[4 * i + 2 * pair] == id("bulb") ? double(objects.data[4 * i + 2 * pair + 1]) : 0;
    }
  // A pixel is 2 * 10 tan(10 degrees) / 16 wide where the ball's middle is.
  const double pixel = 20 * std::tan(0.17453293) / 16;
  CHECK(balls == Approx(3.14159 * 0.25 / (pixel * pixel)).epsilon(0.05));
  CHECK(bulbs > 0);
  for (const float one : aovs.at("march_steps").data) steps += double(one);
  CHECK(steps > 0);
  const auto at = [&](const char* name, int x, int y, int c) { return aovs.at(name).pixel(x, y)[c]; };
  CHECK(at("geometric_normal", 3, 8, 2) == Approx(1));
  CHECK(at("uv", 3, 8, 0) > at("uv", 2, 8, 0));
  CHECK(at("uv", 3, 8, 1) < at("uv", 3, 4, 1));
  CHECK(at("samples", 3, 8, 0) == 1);
  CHECK(at("samples", 12, 1, 0) > 1);
  CHECK(at("variance", 12, 1, 0) > 0);
  CHECK(at("variance", 23, 0, 0) == 0);
  const ImageTexts texts = read_texts(folder / "a.exr");
  CHECK(text_with(texts, "/name", "crypto_object") == "crypto_object");
  CHECK(text_with(texts, "/manifest", "\"ball\":").find("\"wall\":") != std::string::npos);
  CHECK_FALSE(text_with(texts, "/manifest", "\"red\":").empty());
  CHECK(text_with(texts, "/conversion", "uint32") == "uint32_to_float32");
}

TEST_CASE("AOVs that a frame cannot have are refused with the mend") {
  const CliFolder folder;
  const CommandResult plain =
      run_sundog({"render", folder.scene, "-o", folder.file("a.exr"), "--aov", "variance"});
  CHECK(plain.status == 2);
  CHECK(plain.err.find("/render/progressive") != std::string::npos);
  CHECK(
      run_sundog({"render", folder.scene, "-o", folder.file("a.part"), "--tiles", "1/2", "--aov", "samples"})
          .status == 2);
}

TEST_CASE("--far is the depth where nothing is, and changes nothing else") {
  const CliFolder folder;
  const std::string scene = folder.write("aovs.json", scene_text).string();
  const auto depths = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", scene, "-o", folder.file("a.exr"), "--quiet", "--aov", "depth"};
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(run_sundog(words).status == 0);
    return read_aovs(folder / "a.exr").at("depth").data;
  };
  const std::vector<float> plain = depths({});
  std::vector<float> ended = depths({"--far", "1234.5"});
  REQUIRE(std::ranges::count(ended, 1234.5f) > 20);
  std::ranges::replace(ended, 1234.5f, std::numeric_limits<float>::infinity());
  CHECK(ended == plain);
  // Parts keep their depths as they are, and `merge` ends them.
  for (const char* part : {"1/2", "2/2"})
    REQUIRE(run_sundog({"render", scene, "-o", folder.file(part[0] + std::string(".part")), "--aov", "depth",
                        "--tiles", part})
                .status == 0);
  REQUIRE(run_sundog({"merge", folder.file("1.part"), folder.file("2.part"), "-o", folder.file("m.exr"),
                      "--far", "1234.5"})
              .status == 0);
  CHECK(read_aovs(folder / "m.exr").at("depth").data == depths({"--far", "1234.5"}));
}

TEST_CASE("--far without a depth, and --icc of a file without profiles, are refused with the mend") {
  const CliFolder folder;
  const auto refused = [&](const std::string& out, const std::vector<std::string>& more, const char* mend) {
    std::vector<std::string> words{"render", folder.scene, "-o", folder.file(out)};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = run_sundog(words);
    CAPTURE(result.err);
    CHECK(result.status == 2);
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.find(mend) != std::string::npos);
  };
  refused("a.exr", {"--far", "9"}, "give --aov depth");
  refused("a.exr", {"--far", "0", "--aov", "depth"}, "wanted a number above 0");
  refused("a.part", {"--far", "9", "--aov", "depth", "--tiles", "1/2"}, "give --far to merge");
  refused("a.exr", {"--icc"}, ".png and .jpg files");
}
