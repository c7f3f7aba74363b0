// `sundog bake`: a sphere on a board, whose normals, heights and occlusion are known, baked for a square.
#include <base/file.h>
#include <base/pixels/stored_image.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>

#include "catch.h"
#include "run_command.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr double radius = 0.8;
constexpr int size = 64;

const char* const square = R"(v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 3/3 4/4
)";

const std::string objects = R"(
    {"type": "sphere", "radius": 0.8, "material": "m"},
    {"type": "box", "min": [-2, -2, -1], "max": [2, 2, 0], "material": "m"})";

std::string scene_of(const std::string& things, const std::string& material) {
  return R"({"camera": {"position": [0, 0, 40], "target": [0, 0, 0], "fov": 2.6},
  "image": {"width": 32, "height": 32}, "lights": [{"type": "directional", "direction": [-0.15, -0.2, -1]}],
  "textures": {"map": {"type": "image", "file": "normal.png"}},
  "materials": {"mapped": {"normal_map": "map"}, "m": )" +
         material + R"(}, "meshes": {"square": {"file": "square.obj"}}, "objects": [)" + things + "]}";
}

/// A folder with both models.
struct Models {
  TemporaryFolder folder;
  Models() {
    folder.write("square.obj", square);
    std::string high = scene_of(objects, "{}");
    high.erase(high.find("\"textures\""), high.find("\"materials\"") - high.find("\"textures\""));
    high.erase(high.find("\"mapped\""), high.find("\"m\"") - high.find("\"mapped\""));
    folder.write("high.json", high);
  }
  CommandResult bake(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"bake", (folder / "high.json").string(),
                                       (folder / "square.obj").string(), "--size", std::to_string(size)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sundog(arguments);
  }
  StoredImage map(const std::string& kind) const {
    const std::string out = (folder / (kind + ".png")).string();
    const CommandResult result = bake({"--kind", kind, "--cage", "1", "-o", out});
    INFO(result.err);
    REQUIRE(result.status == 0);
    StoredImage image = decode_stored(read_file(out));
    REQUIRE(image.width == size);
    REQUIRE(image.height == size);
    return image;
  }
};

struct Place {
  double x, y, r;  // of a texel's middle on the square, and from its middle
};

Place place_of(int i) {
  const double x = (i % size + 0.5) / size * 2 - 1, y = 1 - (i / size + 0.5) / size * 2;
  return {x, y, std::hypot(x, y)};
}

}  // namespace

TEST_CASE("a baked sphere has the sphere's normals") {
  const Models models;
  const StoredImage map = models.map("normal");
  REQUIRE(map.channels == 4);
  for (int i = 0; i < size * size; ++i) {
    const auto [x, y, r] = place_of(i);
    if (r > 0.77 && r < 0.83) continue;
    const double wanted[3] = {r < radius ? x / radius : 0, r < radius ? y / radius : 0,
                              r < radius ? std::sqrt(radius * radius - r * r) / radius : 1};
    for (std::size_t c = 0; c < 3; ++c) {
      INFO(x << " " << y << " channel " << c);
      REQUIRE(map.data[4 * static_cast<std::size_t>(i) + c] / 127.5 - 1 == Approx(wanted[c]).margin(5e-3));
    }
  }
}

TEST_CASE("baked heights are those over the plain surface, in 16 bits") {
  const Models models;
  const StoredImage map = models.map("height");
  REQUIRE(map.sample == StoredImage::Sample::word);
  for (int i = 0; i < size * size; ++i) {
    const auto [x, y, r] = place_of(i);
    std::uint16_t word = 0;
    std::memcpy(&word, map.data.data() + 2 * i, 2);
    const double height = r < radius ? std::sqrt(radius * radius - r * r) : 0;
    REQUIRE(word / 65535.0 == Approx(0.5 + 0.5 * height).margin(1e-4));
  }
}

TEST_CASE("baked occlusion is what a sphere takes of the sky") {
  const Models models;
  const StoredImage map = models.map("occlusion");
  double found = 0, wanted = 0, count = 0;
  for (int i = 0; i < size * size; ++i) {
    const auto [x, y, r] = place_of(i);
    const double open = map.data[static_cast<std::size_t>(i)] / 255.0;
    if (r < 0.3) CHECK(open > 0.9);  // the board below is all that there is
    if (r < 0.9 || r > 1.3) continue;
    // The form factor of a sphere whose middle lies in the element's plane.
    const double h = r / radius, root = std::sqrt(h * h - 1);
    wanted += 1 - (std::atan(1 / root) - root / (h * h)) / std::numbers::pi;
    found += open;
    ++count;
  }
  CHECK(found / count == Approx(wanted / count).margin(0.01));
}

TEST_CASE("the plain model with its baked map looks like the detailed one") {
  const Models models;
  models.map("normal");
  const auto render = [&](const char* name, const std::string& things, const char* material) {
    const std::string scene =
        models.folder.write(std::string(name) + ".json", scene_of(things, material)).string();
    const std::string out = (models.folder / (std::string(name) + ".exr")).string();
    const CommandResult result = run_sundog({"render", scene, "-o", out, "-q", "--samples", "4"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    return out;
  };
  // Each picture holds the others' solids out of sight: one kernel draws all three.
  const std::string board =
      R"({"type": "mesh", "mesh": "square", "material": "m"},
    {"type": "sphere", "center": [10, 0, 0], "radius": 0.8, "material": "m"},
    {"type": "box", "min": [8, -2, -1], "max": [12, 2, 0], "material": "m"})";
  const std::string detailed = render(
      "detailed",
      objects +
          R"(, {"type": "mesh", "mesh": "square", "material": "m", "transform": [{"translate": [10, 0, 0]}]})",
      R"({"ambient": 0, "diffuse": 1})");
  const std::string mapped = render("mapped", board, R"({"ambient": 0, "diffuse": 1, "normal_map": "map"})");
  const std::string flat = render("flat", board, R"({"ambient": 0, "diffuse": 1})");
  const auto apart = [](const std::string& a, const std::string& b) {
    return nlohmann::json::parse(run_sundog({"compare", a, b, "--json"}).out)["mean"].get<double>();
  };
  CHECK(apart(detailed, mapped) < 0.03);
  CHECK(apart(detailed, flat) > 5 * apart(detailed, mapped));
}

TEST_CASE("texels beside an island take the values of its edge") {
  const Models models;
  // The left half of the square alone, in the left half of the map: its edge goes over the sphere's top.
  models.folder.write("square.obj",
                      "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\n"
                      "vt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  const StoredImage map = models.map("height");
  const auto at = [&](int x, int y) {
    std::uint16_t word = 0;
    std::memcpy(&word, map.data.data() + 2 * (y * size + x), 2);
    return word;
  };
  CHECK(at(31, 32) != 32768);
  CHECK(std::abs(at(34, 32) - at(31, 32)) < 3000);
  CHECK(at(48, 32) == 32768);  // far away there is the plain surface
}

TEST_CASE("what cannot be baked is an error that says why") {
  const Models models;
  const std::string out = (models.folder / "map.png").string();
  const auto check = [&](const CommandResult& result, int status, const char* words) {
    INFO(result.err);
    CHECK(result.status == status);
    CHECK(result.err.find(words) != std::string::npos);
  };
  check(models.bake({"-o", out, "--kind", "color"}), 2, "normal, height or occlusion");
  check(models.bake({"-o", (models.folder / "map.jpg").string()}), 2, ".png");
  check(models.bake({"-o", out, "--cage", "0"}), 2, "--cage");
  check(models.bake({"-o", (models.folder / "square.obj").string()}), 2, "written over");
  models.folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  check(models.bake({"-o", out}), 3, "texture coordinates");
  models.folder.write("square.obj", "v 0 0 9\nv 1 0 9\nv 1 1 9\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
  check(models.bake({"-o", out}), 3, "--cage");
}
