// Alpha composes by over: what covers the background, in every format, by both integrators.
#include <cmath>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

/// From left to right: a wall, nothing, a pane with an opacity of 0.5, a pane that lets 0.7 through, a thin
/// wall; each is six pixels wide. What is behind is green.
constexpr const char* panes = R"({
  "camera": {"position": [0, 0, 10], "target": [0, 0, 0], "fov": 11.4212},
  "image": {"width": 30, "height": 6, "background": [0.2, 0.6, 0.2]},
  "render": {"samples": 64},
  "materials": {
    "wall": {"emission": [0.5, 0.25, 0], "color": [0, 0, 0]},
    "half": {"emission": [0, 0, 0.5], "color": [0, 0, 0], "opacity": 0.5},
    "clear": {"color": [0, 0, 0], "transmission": 0.7},
    "thin": {"type": "dielectric", "thin_walled": true, "ior": 1.5}
  },
  "objects": [
    {"type": "box", "min": [-5, -1, -1], "max": [-3, 1, 0], "material": "wall"},
    {"type": "rectangle", "center": [0, 0, 0], "normal": [0, 0, 1], "material": "half"},
    {"type": "rectangle", "center": [2, 0, 0], "normal": [0, 0, 1], "material": "clear"},
    {"type": "rectangle", "center": [4, 0, 0], "normal": [0, 0, 1], "material": "thin"}
  ]
})";

struct AlphaFolder : CliFolder {
  Image render(const char* text, const std::string& out, std::vector<std::string> more) const {
    const std::string scene_file = write("alpha.json", text).string();
    more.insert(more.begin(), {"render", scene_file, "-o", file(out), "--quiet", "--device", "0:0"});
    const CommandResult result = run_sundog(more);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    return read_image(*this / out);
  }
};

/// The mean of a pane's pixels.
std::array<double, 4> pane(const Image& image, int index) {
  std::array<double, 4> mean{};
  for (int y = 1; y < 5; ++y)
    for (int x = 6 * index + 1; x < 6 * index + 5; ++x)
      for (std::size_t c = 0; c < 4; ++c) mean[c] += double(image.pixel(x, y)[c]) / 16;
  return mean;
}

}  // namespace

TEST_CASE("alpha is what covers the background: surfaces, opacity, transmission and thin walls") {
  const AlphaFolder folder;
  for (const char* integrator : {"whitted", "path"}) {
    const Image image = folder.render(panes, "a.exr", {"--float", "--integrator", integrator});
    CAPTURE(integrator);
    const double f = 0.04, thin = 2 * f / (1 + f);  // what both faces of glass reflect
    const double wanted[] = {1, 0, 0.5, 0.3, thin};
    for (int i = 0; i < 5; ++i) CHECK(pane(image, i)[3] == Approx(wanted[i]).margin(0.03));
    CHECK(pane(image, 1)[1] == Approx(0.6));  // the background stays in the colours
  }
}

TEST_CASE("--transparent leaves the background out, and over brings it back") {
  const AlphaFolder folder;
  for (const char* integrator : {"whitted", "path"}) {
    CAPTURE(integrator);
    const std::vector<std::string> whole = {"--float", "--integrator", integrator};
    std::vector<std::string> more = whole;
    more.emplace_back("--transparent");
    const Image seen = folder.render(panes, "a.exr", whole), cut = folder.render(panes, "b.exr", more);
    CHECK(pane(cut, 1)[1] == 0);
    const float background[] = {0.2f, 0.6f, 0.2f};
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 30; ++x) {
        CHECK(cut.pixel(x, y)[3] == seen.pixel(x, y)[3]);
        for (std::size_t c = 0; c < 3; ++c)
          CHECK(cut.pixel(x, y)[c] + (1 - cut.pixel(x, y)[3]) * background[c] ==
                Approx(seen.pixel(x, y)[c]).margin(2e-3));
      }
  }
}

TEST_CASE("a .png has straight alpha with --transparent, in 8 and 16 bits, of merged parts too") {
  const AlphaFolder folder;
  for (const char* bits : {"8", "16"}) {
    const Image image =
        folder.render(panes, "a.png", {"--transparent", "--bits", bits, "--integrator", "whitted"});
    const auto half = pane(image, 2), wall = pane(image, 0), nothing = pane(image, 1);
    CHECK(half[3] == Approx(0.5).margin(0.003));
    CHECK(half[2] == Approx(0.5).margin(0.01));  // the pane's own colour
    CHECK(wall[0] == Approx(0.5).margin(0.01));
    CHECK(wall[3] == 1);
    CHECK(nothing[3] == 0);
  }
  CHECK(pane(folder.render(panes, "b.png", {}), 1)[3] == 1);
  folder.render(panes, "c.png", {"--transparent", "--integrator", "whitted"});
  const CommandResult part =
      run_sundog({"render", folder.file("alpha.json"), "-o", folder.file("c.part"), "--tiles", "1/1",
                  "--transparent", "--integrator", "whitted", "--device", "0:0"});
  REQUIRE(part.status == 0);
  REQUIRE(run_sundog({"merge", folder.file("c.part"), "-o", folder.file("d.png"), "--transparent"}).status ==
          0);
  CHECK(read_image(folder / "d.png").data == read_image(folder / "c.png").data);
}

TEST_CASE("fog covers what is behind it, and glass that bends light covers all") {
  const AlphaFolder folder;
  const std::string open = R"({"camera": {"position": [0, 0, 10], "target": [0, 0, 0], "fov": 20},
    "image": {"width": 8, "height": 8, "background": [0, 1, 0]}, "materials": {"glass": {"type": "dielectric", "ior": 1.5}},
    "objects": [{"type": "sphere", "material": "glass"}])";
  for (const char* integrator : {"whitted", "path"}) {
    CAPTURE(integrator);
    const Image glass = folder.render((open + "}").c_str(), "a.exr", {"--integrator", integrator});
    CHECK(glass.pixel(4, 4)[3] == 1);
    CHECK(glass.pixel(0, 0)[3] == 0);
    const std::string fog = open + R"(, "world": {"fog": {"density": 0.1, "color": [0.7, 0.7, 0.7]}}})";
    const Image foggy = folder.render(fog.c_str(), "b.exr", {"--integrator", integrator, "--transparent"});
    CHECK(foggy.pixel(0, 0)[3] == 1);
    CHECK(foggy.pixel(0, 0)[0] == Approx(0.7).epsilon(0.01));
  }
}

TEST_CASE("--adaptive sees edges that only alpha shows") {
  const AlphaFolder folder;
  constexpr const char* ball = R"({"camera": {"position": [0, 0, 10], "target": [0, 0, 0], "fov": 20},
    "image": {"width": 32, "height": 32}, "render": {"samples": 64},
    "materials": {"black": {"color": [0, 0, 0]}}, "objects": [{"type": "sphere", "material": "black"}]})";
  const Image full = folder.render(ball, "a.exr", {}),
              adaptive = folder.render(ball, "b.exr", {"--adaptive", "0.02"});
  double worst = 0;
  for (std::size_t i = 3; i < full.data.size(); i += 4)
    worst = std::max(worst, std::abs(double(full.data[i]) - double(adaptive.data[i])));
  CHECK(worst < 0.15);
}

TEST_CASE("by option, smooth glass covers only what it holds back of the background") {
  const AlphaFolder folder;
  // A clear ball, a grey block, glass that is rough, and a wall behind a part of the ball.
  const std::string glass = R"({"camera": {"position": [0, 0, 10], "target": [0, 0, 0], "fov": 20},
    "image": {"width": 24, "height": 16, "background": [0.2, 0.6, 0.4], "transparent_glass": true},
    "render": {"samples": 16}, "materials": {
      "ball": {"type": "dielectric", "ior": 1.5}, "wall": {"color": [0.5, 0.5, 0.5]},
      "block": {"type": "dielectric", "ior": 1.3, "transmission": 0.5},
      "rough": {"type": "dielectric", "ior": 1.5, "roughness": 0.3}},
    "lights": [{"type": "directional", "direction": [0, 0, -1]}],
    "objects": [{"type": "sphere", "center": [-1, 0, 0], "radius": 1, "material": "ball"},
      {"type": "box", "min": [0.2, -1, -1], "max": [1.1, 1, 0], "material": "block"},
      {"type": "box", "min": [1.4, -1, -1], "max": [2.4, 1, 0], "material": "rough"},
      {"type": "sphere", "center": [-1.3, 0, -3], "radius": 0.4, "material": "wall"}]})";
  for (const char* integrator : {"whitted", "path"}) {
    CAPTURE(integrator);
    const std::vector<std::string> whole = {"--float", "--integrator", integrator, "--max-depth", "32"};
    std::vector<std::string> more = whole;
    more.insert(more.end(), {"--transparent", "--aov", "crypto_object"});
    const Image seen = folder.render(glass.c_str(), "a.exr", whole),
                cut = folder.render(glass.c_str(), "b.exr", more);
    const float background[] = {0.2f, 0.6f, 0.4f};
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 24; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          CHECK(cut.pixel(x, y)[c] + (1 - cut.pixel(x, y)[3]) * background[c] ==
                Approx(seen.pixel(x, y)[c]).margin(2e-3));
    const double f = std::pow(0.3 / 2.3, 2);  // what a face of the block reflects
    CHECK(cut.pixel(15, 8)[3] == Approx(1 - 0.25 * (1 - f) * (1 - f)).margin(0.03));
    CHECK(cut.pixel(7, 8)[3] > 0.9f);   // the wall
    CHECK(cut.pixel(19, 8)[3] > 0.9f);  // rough glass covers
    CHECK(cut.pixel(7, 4)[3] < 0.2f);
  }
}

TEST_CASE("a camera inside glass sees alpha as one outside does") {
  const AlphaFolder folder;
  const char* inside = R"({
    "camera": {"position": [0, 0, 0], "target": [0, 0, 1], "fov": 20},
    "image": {"width": 16, "height": 16, "background": [0.5, 0.5, 0.5], "transparent_glass": true},
    "render": {"samples": 64}, "materials": {"glass": {"type": "dielectric", "ior": 1.5}},
    "objects": [{"type": "sphere", "radius": 1, "material": "glass"}]})";
  for (const char* integrator : {"whitted", "path"}) {
    CAPTURE(integrator);
    const Image image =
        folder.render(inside, "i.exr", {"--float", "--transparent", "--integrator", integrator});
    double mean = 0;
    for (std::size_t i = 3; i < image.data.size(); i += 4) {
      CHECK(image.data[i] >= -1e-5f);
      mean += double(image.data[i]) / (16 * 16);
    }
    CHECK(mean == Approx(0.04).margin(0.02));
  }
}
