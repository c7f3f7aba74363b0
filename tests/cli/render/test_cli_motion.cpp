// The AOV motion: the way of what a pixel shows to the next frame.
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

constexpr int width = 30, height = 20;

/// A wall across the left half at z = -2, and a ball at the right that moves with the frames.
constexpr const char* moving = R"({
  "camera": {"position": [0, 0, 10], "target": [0, 0, 0], "fov": 30},
  "image": {"width": 30, "height": 20, "background": [0.1, 0.2, 0.3]},
  "materials": {"m": {"color": [0.8, 0.8, 0.8]}},
  "objects": [
    {"name": "wall", "type": "box", "min": [-9, -9, -3], "max": [0, 9, -2], "material": "m"},
    {"name": "ball", "type": "sphere", "center": [1.5, 0, 0], "radius": 0.8, "material": "m"}
  ]
})";

/// Pixels for each unit of tan(angle), and per unit of length at that depth.
const double focal = height / 2 / std::tan(15 * 3.14159265358979 / 180);

struct MotionFolder : CliFolder {
  json scene = json::parse(moving);

  std::string scene_file() const { return write("moving.json", scene.dump()).string(); }
  Image render(const std::string& out, std::vector<std::string> more) const {
    more.insert(more.begin(), {"render", scene_file(), "-o", file(more.empty() ? out : "m.exr"), "--quiet",
                               "--aov", "motion", "--device", "0:0"});
    const CommandResult result = run_sundog(more);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    return read_aovs(*this / out).at("motion");
  }
  void animate(const char* pointer, const json& from, const json& to) {
    scene["animate"].push_back({{"value", pointer},
                                {"type", "linear"},
                                {"keys", {{{"frame", 0}, {"value", from}}, {{"frame", 4}, {"value", to}}}}});
  }
};

/// The way of a pixel through a turn of the camera by `angle` to the left about the vertical.
std::array<double, 2> turned(int x, int y, double angle) {
  const double u = (x + 0.5 - width / 2.0) / focal, v = (height / 2.0 - y - 0.5) / focal;
  // The direction (u, v, 1) in the camera that is turned.
  const double right = u * std::cos(angle) + std::sin(angle), ahead = std::cos(angle) - u * std::sin(angle);
  return {focal * (right / ahead - u), focal * (v / ahead - v)};
}

}  // namespace

TEST_CASE("motion of an object is the difference of its projections, and nothing else moves") {
  MotionFolder folder;
  folder.animate("/objects/ball/center", {1.5, 0, 0}, {1.9, 0.8, 0});
  const Image motion = folder.render("m_0001.exr", {"--frames", "1"});
  const int y = 9;
  int seen = 0;
  for (int x = 15; x < width; ++x) {
    // In frame 1 the ball's middle is at (1.6, 0.2, 0).
    const double u = (x + 0.5 - width / 2.0) / focal, v = (height / 2.0 - y - 0.5) / focal;
    const double a = u * u + v * v + 1, b = -1.6 * u - 0.2 * v - 10, c = 1.6 * 1.6 + 0.2 * 0.2 + 100 - 0.64;
    if (b * b - a * c < 0.1) continue;
    ++seen;
    const double depth = (-b - std::sqrt(b * b - a * c)) / a;
    CHECK(motion.pixel(x, y)[0] == Approx(focal * 0.1 / depth).margin(1e-3));
    CHECK(motion.pixel(x, y)[1] == Approx(focal * 0.2 / depth).margin(1e-3));
  }
  CHECK(seen > 4);
  for (const int x : {2, 7, 29}) {
    CHECK(motion.pixel(x, 15)[0] == Approx(0).margin(1e-4));
    CHECK(motion.pixel(x, 15)[1] == Approx(0).margin(1e-4));
  }
}

TEST_CASE(
    "motion by a camera that pans is the same for surfaces and the sky, and that of a dolly for depth") {
  MotionFolder folder;
  // The target moves straight: frame 1 is at a quarter of the tangent.
  const double angle = 0.02;
  folder.animate("/camera/target", {0, 0, 0}, {-40 * std::tan(angle), 0, 0});
  const Image pan = folder.render("m_0000.exr", {"--frames", "0"});
  for (const auto& [x, y] : {std::pair(3, 4), {12, 10}, {20, 10}, {29, 0}}) {
    const auto way = turned(x, y, angle);
    CHECK(pan.pixel(x, y)[0] == Approx(way[0]).margin(0.01));
    CHECK(pan.pixel(x, y)[1] == Approx(way[1]).margin(0.01));
  }
  MotionFolder dolly;
  dolly.animate("/camera/position", {0, 0, 10}, {0, 0, 6});
  const Image closer = dolly.render("m_0002.exr", {"--frames", "2"});  // from z = 8 to 7
  const double place = 3.5 - width / 2.0;
  CHECK(closer.pixel(3, 10)[0] == Approx(place * 10 / 9 - place).margin(0.01));
  CHECK(closer.pixel(29, 0)[0] == Approx(0).margin(1e-3));  // the sky
}

TEST_CASE("motion in a still is that of its own open shutter, and merged parts have the bits of the whole") {
  MotionFolder folder;
  folder.scene["objects"][1]["moves_by"] = {0.5, 0, 0};
  const Image still = folder.render("m.exr", {"--samples", "4"});
  CHECK(still.pixel(20, 10)[0] > 1);
  CHECK(still.pixel(3, 10)[0] == Approx(0).margin(1e-4));
  for (const char* which : {"1", "2"})
    REQUIRE(run_sundog({"render", folder.scene_file(), "-o", folder.file(std::string(which) + ".part"),
                        "--tiles", std::string(which) + "/2", "--aov", "motion", "--samples", "4", "--quiet",
                        "--device", "0:0"})
                .status == 0);
  REQUIRE(run_sundog({"merge", folder.file("1.part"), folder.file("2.part"), "-o", folder.file("n.exr")})
              .status == 0);
  CHECK(read_file(folder / "n.exr") == read_file(folder / "m.exr"));
}

TEST_CASE("motion follows a mesh that changes its shape, in merged parts too") {
  MotionFolder folder;
  const char* faces = "f 1 2 3\nf 1 3 4\n";
  folder.write("a.obj", std::string("v -3 -2 0\nv 3 -2 0\nv 3 2 0\nv -3 2 0\n") + faces);
  folder.write("b.obj", std::string("v -3 -2 0\nv 4 -2 0\nv 4 2 0\nv -3 2 0\n") + faces);
  folder.scene["meshes"] = {{"sheet", {{"file", "a.obj"}}}};
  folder.scene["objects"] = {{{"type", "mesh"}, {"mesh", "sheet"}, {"material", "m"}}};
  folder.scene["animate"] = {
      {{"value", "/meshes/sheet/file"},
       {"type", "step"},
       {"keys", {{{"frame", 0}, {"value", "a.obj"}}, {{"frame", 1}, {"value", "b.obj"}}}}}};
  const Image motion = folder.render("m_0000.exr", {"--frames", "0"});
  for (int x = 5; x < width - 5; ++x) {
    const double place = (x + 0.5 - width / 2.0) / focal * 10, inside = std::abs(place) < 3;
    // Stretched by 7 / 6 from its left edge.
    CHECK(motion.pixel(x, 10)[0] == Approx(inside * (place + 3) / 6 * focal / 10).margin(1e-3));
    CHECK(motion.pixel(x, 10)[1] == Approx(0).margin(1e-3));
  }
  for (const char* which : {"1", "2"})
    REQUIRE(run_sundog({"render", folder.scene_file(), "-o", folder.file(std::string(which) + ".part"),
                        "--frames", "0", "--tiles", std::string(which) + "/2", "--aov", "motion", "--quiet",
                        "--device", "0:0"})
                .status == 0);
  REQUIRE(run_sundog(
              {"merge", folder.file("1_0000.part"), folder.file("2_0000.part"), "-o", folder.file("n.exr")})
              .status == 0);
  CHECK(read_aovs(folder / "n.exr").at("motion").data == motion.data);
}
