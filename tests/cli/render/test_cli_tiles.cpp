// Pictures do not depend on which pixels are drawn together.
#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

// Waves whose angles are great far out, where libraries take another way for all lanes at once.
constexpr const char* waves = R"json({
  "camera": {"position": [0, 3, 0], "target": [0, 2, -9], "fov": 50},
  "image": {"width": 48, "height": 32, "background": [0.2, 0.4, 0.8]},
  "render": {"integrator": "path", "samples": 8},
  "lights": [{"type": "directional", "direction": [-1, -1, -1]}],
  "materials": {"sea": {"color": [0.8, 0.8, 0.8]}},
  "objects": [{"type": "formula", "material": "sea", "distance": "p.y + 0.1 * sin(5 * p.x) * cos(5 * p.z)",
    "interval": {"min": [-90, -1, -90], "max": [90, 1, 0]}}]
})json";

}  // namespace

TEST_CASE("a field with great angles has the same bits for every size of tile") {
  const CliFolder folder;
  const std::string scene = folder.write("waves.json", waves).string();
  std::string first;
  for (const char* tile : {"4", "8", "64"}) {
    CAPTURE(tile);
    const CommandResult result = run_sundog(
        {"render", scene, "-o", folder.file("a.pfm"), "--quiet", "--device", "0:0", "--tile", tile});
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    const std::string bytes = read_file(folder / "a.pfm");
    if (first.empty()) first = bytes;
    CHECK(bytes == first);
  }
}
