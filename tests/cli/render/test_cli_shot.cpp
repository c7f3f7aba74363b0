// An EXR states its camera and film in OpenEXR's standard attributes.
#include <fmt/format.h>
#include <ImfFloatAttribute.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfRationalAttribute.h>

#include <cmath>
#include <limits>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

/// A board that a camera passes, whose lens is open, in a film of 30 frames a second.
constexpr const char* passing = R"({
  "frames_per_second": 29.97, "unit": 0.5,
  "camera": {"position": [3, 2, 7], "target": [0.5, -0.2, 0], "fov": 40, "up": [0.1, 1, 0.2]},
  "image": {"width": 24, "height": 16},
  "animate": [{"value": "/camera/position", "type": "linear",
               "keys": [{"frame": 0, "value": [3, 2, 7]}, {"frame": 4, "value": [-3, 1, 5]}]}],
  "objects": [{"type": "plane", "point": [0, -1, 0], "normal": [0.2, 1, 0.3], "material": "m"}],
  "materials": {"m": {"color": [0.8, 0.8, 0.8]}}
})";

Imf::Header header_of(const std::filesystem::path& file) {
  return Imf::InputFile(file.string().c_str()).header();
}

template <class Attribute>
auto value_of(const Imf::Header& header, const char* name) {
  const auto* found = header.findTypedAttribute<Attribute>(name);
  INFO(name);
  REQUIRE(found);
  return found->value();
}

/// The farthest that the matrices put a visible surface point from the pixel that shows it, in pixels, and
/// from its depth.
std::pair<float, float> misplaced(const std::filesystem::path& file) {
  const Imf::Header header = header_of(file);
  const auto ndc = value_of<Imf::M44fAttribute>(header, "worldToNDC"),
             camera = value_of<Imf::M44fAttribute>(header, "worldToCamera");
  AovImages aovs = read_aovs(file);
  const Image &positions = aovs.at("position"), &depth = aovs.at("depth");
  std::pair<float, float> worst;
  int seen = 0;
  for (int y = 0; y < positions.height; ++y)
    for (int x = 0; x < positions.width; ++x) {
      if (!std::isfinite(*depth.pixel(x, y))) continue;
      ++seen;
      const float* p = positions.pixel(x, y);
      const Imath::V3f at = Imath::V3f(p[0], p[1], p[2]) * ndc, near = Imath::V3f(p[0], p[1], p[2]) * camera;
      worst.first = std::max({worst.first, std::abs(at.x * 24 - static_cast<float>(x) - 0.5f),
                              std::abs(at.y * 16 - static_cast<float>(y) - 0.5f)});
      worst.second = std::max(worst.second, std::abs(near.z - *depth.pixel(x, y)));
    }
  CHECK(seen > 100);
  return worst;
}

void render(const std::vector<std::string>& more) {
  std::vector<std::string> words{"render", "--quiet", "--aov", "position", "--aov", "depth"};
  words.insert(words.end(), more.begin(), more.end());
  const CommandResult result = run_sundog(words);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
}

}  // namespace

TEST_CASE("the camera's matrices in an EXR put what is seen where the picture shows it, in each frame") {
  const CliFolder folder;
  const std::string scene = folder.write("passing.json", passing).string();
  render({scene, "-o", folder.file("f.exr"), "--frames", "0..2", "--step", "2"});
  for (const char* name : {"f_0000.exr", "f_0002.exr"}) {
    const auto [pixels, depth] = misplaced(folder / name);
    CHECK(pixels < 1e-3f);
    CHECK(depth < 1e-4f);
  }
  const Imf::Header header = header_of(folder / "f_0002.exr");
  CHECK(header.screenWindowWidth() == Approx(2 * std::tan(20 * 3.14159265358979 / 180) * 24 / 16));
  CHECK(value_of<Imf::IntAttribute>(header, "imageCounter") == 2);
  const auto rate = value_of<Imf::RationalAttribute>(header, "framesPerSecond");
  CHECK((rate.n == 30000 && rate.d == 1001));
  CHECK(header.find("focus") == header.end());
  CHECK(header.find("expTime") == header.end());
}

TEST_CASE("an EXR says the distance in focus in metres, and for how long the shutter is open") {
  const CliFolder folder;
  const std::string scene = folder.write("passing.json", passing).string();
  render({scene, "-o", folder.file("a.exr"), "--set", "/camera/lens={\"radius\": 0.1, \"focus\": 3}"});
  const Imf::Header still = header_of(folder / "a.exr");
  CHECK(value_of<Imf::FloatAttribute>(still, "focus") == 1.5f);
  for (const char* name : {"imageCounter", "framesPerSecond", "expTime"})
    CHECK(still.find(name) == still.end());
  render({scene, "-o", folder.file("f.exr"), "--frames", "1", "--set", "/camera/shutter=0.5"});
  CHECK(value_of<Imf::FloatAttribute>(header_of(folder / "f_0001.exr"), "expTime") == Approx(0.5 / 29.97));
}
