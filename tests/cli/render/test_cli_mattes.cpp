// Cryptomatte takes part in the pixel's own samples: lens, time, filter, weights and opacity.
#include <bit>
#include <cmath>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"
#include "render/film/cryptomatte.h"

using namespace sundog;

namespace {

/// A ball out of focus and one that moves, both before nothing; below, a pane of opacity 0.5, half of it
/// before a wall.
constexpr const char* blurred = R"({
  "camera": {"position": [0, 0, 6], "target": [0, 0, 0], "fov": 40, "lens": {"radius": 0.4, "focus": 6}},
  "image": {"width": 32, "height": 24, "background": [0.2, 0.4, 0.8]},
  "render": {"samples": 16},
  "lights": [{"type": "ambient"}],
  "materials": {
    "white": {"color": [1, 1, 1], "ambient": 1},
    "pane": {"color": [1, 0, 0], "ambient": 1, "diffuse": 0, "specular": 0, "opacity": 0.5}
  },
  "objects": [
    {"name": "near", "type": "sphere", "radius": 0.6, "center": [-1, 0.8, 2], "material": "white"},
    {"name": "mover", "type": "sphere", "radius": 0.3, "center": [0.5, 0.8, -3], "moves_by": [2, 0, 0],
     "material": "white"},
    {"name": "pane", "type": "rectangle", "size": [4, 1.6], "center": [0, -1.2, 0], "normal": [0, 0, 1],
     "material": "pane"},
    {"name": "wall", "type": "rectangle", "size": [2, 1.6], "center": [1.2, -1.6, -1], "normal": [0, 0, 1],
     "material": "white"}
  ]
})";

struct MatteFolder : CliFolder {
  std::string scene_file = write("blurred.json", blurred).string();

  void render(std::vector<std::string> more) const {
    more.insert(more.begin(),
                {"render", scene_file, "-o", file("a.exr"), "--float", "--quiet", "--device", "0:0"});
    for (const char* name : {"crypto_object", "crypto_material"}) more.insert(more.end(), {"--aov", name});
    const CommandResult result = run_sundog(more);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
  }
};

/// The part of a pixel that the named thing covers; without a name, the sum of all parts.
float coverage(const AovImages& aovs, const std::string& kind, int x, int y, const std::string& name = "") {
  float sum = 0;
  for (const char* layer : {"00", "01", "02"})
    for (int pair = 0; pair < 2; ++pair) {
      const float* of = aovs.at(kind + layer).pixel(x, y) + 2 * pair;
      if (name.empty() || of[0] == std::bit_cast<float>(id_bits(name))) sum += of[1];
    }
  return sum;
}

}  // namespace

TEST_CASE("coverages of objects and of materials sum to alpha, through lens, motion, filter and opacity") {
  const MatteFolder folder;
  const std::vector<std::string> ways[] = {
      {}, {"--filter", "gaussian"}, {"--adaptive", "0.05", "--samples", "64"}};
  for (const char* integrator : {"whitted", "path"})
    for (std::vector<std::string> way : ways) {
      CAPTURE(integrator, way);
      way.insert(way.end(), {"--integrator", integrator});
      folder.render(way);
      const AovImages aovs = read_aovs(folder / "a.exr");
      const Image picture = read_image(folder / "a.exr");
      float most = 0;
      int partial = 0;
      for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
          const float alpha = picture.pixel(x, y)[3];
          partial += alpha > 0.05f && alpha < 0.95f;
          for (const char* kind : {"crypto_object", "crypto_material"})
            most = std::max(most, std::abs(coverage(aovs, kind, x, y) - alpha));
        }
      CHECK(most < 1e-4f);
      CHECK(partial > 100);
    }
}

TEST_CASE("opacity splits a pixel between a pane and the wall behind it") {
  const MatteFolder folder;
  for (const char* integrator : {"whitted", "path"}) {
    CAPTURE(integrator);
    folder.render({"--integrator", integrator, "--samples", "256"});
    const AovImages aovs = read_aovs(folder / "a.exr");
    CHECK(coverage(aovs, "crypto_object", 21, 18, "pane") == Approx(0.5f).margin(0.02));
    CHECK(coverage(aovs, "crypto_object", 21, 18, "wall") == Approx(0.5f).margin(0.02));
    CHECK(coverage(aovs, "crypto_material", 21, 18, "white") == Approx(0.5f).margin(0.02));
    CHECK(coverage(aovs, "crypto_object", 8, 18, "pane") == Approx(0.5f).margin(0.02));
    CHECK(coverage(aovs, "crypto_object", 8, 18) == Approx(0.5f).margin(0.02));
  }
}

TEST_CASE("a medium covers for its object what it scatters or absorbs, before a wall and before nothing") {
  const CliFolder folder;
  const auto seen = [&](const std::string& key, const std::string& integrator, bool walled) {
    const std::string scene =
        R"({"camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 5},
            "image": {"width": 8, "height": 8, "background": [0, 0, 0]},
            "render": {"samples": 256, "integrator": ")" +
        integrator + R"("}, "media": {"m": {"ior": 1, ")" + key +
        R"(": [0.3, 0.3, 0.3]}}, "materials": {"m": {"type": "dielectric", "medium": "m"}, "w": {}},
            "objects": [{"name": "mist", "type": "box", "half": 0.5, "material": "m"})" +
        (walled ? R"(, {"name": "wall", "type": "rectangle", "size": [9, 9], "center": [0, 0, -3],
                        "normal": [0, 0, 1], "material": "w"}]})"
                : "]}");
    const CommandResult result =
        run_sundog({"render", folder.write("mist.json", scene).string(), "-o", folder.file("a.exr"),
                    "--float", "--quiet", "--device", "0:0", "--aov", "crypto_object"});
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    const AovImages aovs = read_aovs(folder / "a.exr");
    const Image picture = read_image(folder / "a.exr");
    double mist = 0, wall = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        CHECK(coverage(aovs, "crypto_object", x, y) == Approx(picture.pixel(x, y)[3]).margin(1e-4));
        mist += double(coverage(aovs, "crypto_object", x, y, "mist")) / 64;
        wall += double(coverage(aovs, "crypto_object", x, y, "wall")) / 64;
      }
    CHECK(mist == Approx(1 - std::exp(-0.3)).margin(0.012));
    CHECK(wall == Approx(walled ? std::exp(-0.3) : 0).margin(0.012));
  };
  for (const bool walled : {false, true}) {
    seen("scattering", "path", walled);
    seen("absorption", "path", walled);
    seen("absorption", "whitted", walled);
  }
}

TEST_CASE("mattes have the same bits whatever the tiles, and in parts that are merged") {
  const MatteFolder folder;
  folder.render({});
  const std::string whole = read_file(folder / "a.exr");
  folder.render({"--tile", "7"});
  CHECK(read_file(folder / "a.exr") == whole);
  for (const char* which : {"1", "2"})
    REQUIRE(run_sundog({"render", folder.scene_file, "-o", folder.file(std::string(which) + ".part"),
                        "--tiles", std::string(which) + "/2", "--aov", "crypto_object", "--aov",
                        "crypto_material", "--quiet", "--device", "0:0"})
                .status == 0);
  REQUIRE(run_sundog(
              {"merge", folder.file("2.part"), folder.file("1.part"), "-o", folder.file("m.exr"), "--float"})
              .status == 0);
  CHECK(read_file(folder / "m.exr") == whole);
}
