// Every AOV shows the surfaces that the picture shows: through cutouts, and behind one-sided faces.
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"
#include "render/film/cryptomatte.h"

using namespace sundog;

namespace {

/// In the left half a screen that is cut away, in the right half one that is seen from its missing side; a
/// wall is behind the upper half of both.
constexpr const char* screens = R"({
  "camera": {"position": [0, 0, 10], "target": [0, 0, 0], "fov": 20},
  "image": {"width": 24, "height": 16},
  "render": {"samples": 4},
  "lights": [{"type": "point", "position": [0, 3, 9]}],
  "materials": {
    "hole": {"color": [1, 0, 0], "opacity": 0},
    "front": {"color": [1, 0, 0], "sides": "front"},
    "white": {"color": [0.75, 0.5, 0.25], "diffuse": 1, "ambient": 0}
  },
  "objects": [
    {"name": "hole", "type": "rectangle", "size": [9, 9], "center": [-4.5, 0, 2], "normal": [0, 0, 1],
     "material": "hole"},
    {"name": "back", "type": "rectangle", "size": [9, 9], "center": [4.5, 0, 2], "normal": [0, 0, -1],
     "material": "front"},
    {"name": "wall", "type": "box", "min": [-9, 0, -2], "max": [9, 9, -1], "material": "white"}
  ]
})";

}  // namespace

TEST_CASE("AOVs, mattes, alpha and the denoiser's features see through what is cut away") {
  const CliFolder folder;
  const std::string scene = folder.write("screens.json", screens).string();
  for (const char* integrator : {"whitted", "path"}) {
    CAPTURE(integrator);
    std::vector<std::string> command{"render",  scene,          "-o",       folder.file("a.exr"), "--float",
                                     "--quiet", "--integrator", integrator, "--device",           "0:0"};
    for (const char* name :
         {"depth", "object", "material", "normal", "albedo", "position", "denoise_albedo", "crypto_object"})
      command.insert(command.end(), {"--aov", name});
    const CommandResult result = run_sundog(command);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    const AovImages aovs = read_aovs(folder / "a.exr");
    const Image picture = read_image(folder / "a.exr");
    const auto at = [&](const char* name, int x, int y, int c = 0) { return aovs.at(name).pixel(x, y)[c]; };
    for (const int x : {4, 19}) {
      CAPTURE(x);
      CHECK(at("object", x, 3) == 2);
      CHECK(at("material", x, 3) == 2);
      CHECK(at("depth", x, 3) == Approx(11));
      CHECK(at("position", x, 3, 2) == Approx(-1));
      CHECK(at("normal", x, 3, 2) == Approx(1));
      CHECK(at("albedo", x, 3) == Approx(0.75));
      CHECK(at("denoise_albedo", x, 3, 1) == Approx(0.5));
      CHECK(at("crypto_object00", x, 3) == std::bit_cast<float>(id_bits("wall")));
      CHECK(at("crypto_object00", x, 3, 1) == Approx(1));
      CHECK(picture.pixel(x, 3)[3] == 1);
      CHECK(at("object", x, 12) == -1);
      CHECK(std::isinf(at("depth", x, 12)));
      CHECK(at("denoise_albedo", x, 12) == 0);
      CHECK(at("crypto_object00", x, 12, 1) == 0);
      CHECK(picture.pixel(x, 12)[3] == 0);
    }
  }
}

namespace {

/// The picture of the screens, the left one of that opacity, with `--subsample` at one sample a pixel. Balls
/// smaller than a pixel stand in the middles of pixels (x, 13).
Image subsampled(double opacity, std::initializer_list<int> balls) {
  const CliFolder folder;
  nlohmann::json scene = nlohmann::json::parse(screens);
  scene["render"]["samples"] = 1;
  scene["materials"]["hole"]["opacity"] = opacity;
  const double pixel = 20 * std::tan(0.17453292519943295) / 16;  // its width at z = 0
  for (const int x : balls)
    scene["objects"].push_back({{"type", "sphere"},
                                {"radius", 0.3 * pixel},
                                {"center", {(x + 0.5 - 12) * pixel, (8 - 12.5 - 1) * pixel, 0}},
                                {"material", "white"}});
  const std::string file = folder.write("dots.json", scene.dump()).string();
  const CommandResult result =
      run_sundog({"render", file, "-o", folder.file("a.exr"), "--subsample", "--quiet"});
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  return read_image(folder / "a.exr");
}

}  // namespace

TEST_CASE("--subsample keeps what stands behind a cut-out in the middle of a single pixel") {
  const Image picture = subsampled(0, {3, 19});
  CHECK(picture.pixel(3, 13)[3] == 1);
  CHECK(picture.pixel(19, 13)[3] == 1);
  CHECK(picture.pixel(5, 13)[3] == 0);
}

TEST_CASE("--subsample keeps what stands behind a pane of opacity 0.5 in the middle of a single pixel") {
  const Image picture = subsampled(0.5, {3});
  CHECK(picture.pixel(3, 13)[3] == 1);
  CHECK(picture.pixel(5, 13)[3] == Approx(0.5));
}

TEST_CASE("a cutoff leaves the same share of a pattern near and far") {
  const CliFolder folder;
  const std::string scene = folder
                                .write("leaves.json", R"({
    "camera": {"position": [0, 0, 4], "target": [0, 0, 0], "orthographic": 1},
    "image": {"width": 8, "height": 8, "background": [0, 0, 0]},
    "render": {"samples": 64},
    "textures": {"holes": {"type": "checker", "size": 0.0137}},
    "materials": {"leaves": {"diffuse": 0, "ambient": 0, "emission": 1, "opacity": "holes", "cutoff": 0.6}},
    "objects": [{"type": "rectangle", "size": [2, 2], "normal": [0, 0, 1], "material": "leaves"}]})")
                                .string();
  for (const char* integrator : {"whitted", "path"}) {
    const CommandResult result = run_sundog({"render", scene, "-o", folder.file("a.exr"), "--quiet",
                                             "--integrator", integrator, "--device", "0:0"});
    CAPTURE(integrator, result.err);
    REQUIRE(result.status == 0);
    const Image picture = read_image(folder / "a.exr");
    double sum = 0;
    for (std::size_t i = 0; i < picture.data.size(); i += 4) sum += double(picture.data[i]) / 64;
    CHECK(sum == Approx(0.5).epsilon(0.04));
  }
}
