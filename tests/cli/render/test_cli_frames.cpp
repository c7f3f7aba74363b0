// Animations: numbered files, an image a frame.
#include <base/file.h>
#include <base/image_io.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

/// The small scene, its camera going up.
std::string moving_scene(const CliFolder& folder) {
  json scene = json::parse(small_scene);
  scene["animate"] = json::parse(R"([{"type": "linear", "value": "/camera/position",
    "keys": [{"frame": 0, "value": [0, 1, 5]}, {"frame": 2, "value": [0, 3, 5]}]}])");
  return folder.write("moving.json", scene.dump()).string();
}

CommandResult render_frames(const CliFolder& folder, const std::string& out, const std::string& frames,
                            std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"render",         moving_scene(folder), "-o",
                                     folder.file(out), "--frames",           frames};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_sundog(arguments);
}

}  // namespace

TEST_CASE("each frame of an animation is the scene with that frame's values, in a numbered file") {
  const CliFolder folder;
  const CommandResult result =
      render_frames(folder, "f#####.pfm", "1..2", {"--stats", folder.file("s.json")});
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  const CommandResult still = run_sundog(
      {"render", folder.scene, "-o", folder.file("still.pfm"), "--set", "/camera/position=[0,2,5]"});
  REQUIRE(still.status == 0);
  CHECK(read_file(folder / "f00001.pfm") == read_file(folder / "still.pfm"));
  CHECK(read_file(folder / "f00002.pfm") != read_file(folder / "still.pfm"));
  REQUIRE(render_frames(folder, "f%03d.pfm", "2", {}).status == 0);
  CHECK(read_file(folder / "f002.pfm") == read_file(folder / "f00002.pfm"));
  const json first = json::parse(read_file(folder / "s_0001.json")),
             second = json::parse(read_file(folder / "s_0002.json"));
  CHECK(first["image"]["file"] == folder.file("f00001.pfm"));
  CHECK(second["kernels_cached"] == true);  // the device stays open
}

TEST_CASE("frames that cannot be are refused") {
  const CliFolder folder;
  for (const char* frames : {"x", "1..", "-1..2", "1...2", "1e3", "99999999", "1,,2", "1,", "0..1..2"})
    CHECK(render_frames(folder, "a.png", frames).status == 2);
  CHECK(render_frames(folder, "a.png", "0..4", {"--step", "0"}).status == 2);
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--skip-existing"}).status == 2);
  const CommandResult still =
      run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--frames", "0..1"});
  CHECK(still.status == 3);
  CHECK(is_one_error_line(still.err));
  CHECK(still.err.find("animate") != std::string::npos);
}

TEST_CASE("the noise of frames is not that of their neighbours") {
  const CliFolder folder;
  json scene = json::parse(small_scene);
  scene["lights"] = json::parse(
      R"([{"type": "rectangle", "position": [0, 4, 0], "target": [0, 0, 0], "size": [3, 3], "intensity": 5}])");
  scene["objects"] = json::parse(R"([{"type": "plane", "point": [0, -1, 0], "material": "floor"},
    {"type": "sphere", "material": "floor"}])");
  scene["render"] = {{"integrator", "path"}};
  scene["animate"] = json::array();
  folder.write("noisy.json", scene.dump());
  const auto mean_error = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{
        "render", folder.file("noisy.json"), "-o", folder.file("n.pfm"), "--frames", "0..15", "--samples",
        "4"};
    all.insert(all.end(), more.begin(), more.end());
    REQUIRE(run_sundog(all).status == 0);
    const Image truth = read_image(folder / "truth.pfm");
    std::vector<double> sum(truth.data.size());
    double one = 0, mean = 0;
    for (int frame = 0; frame < 16; ++frame) {
      const Image image =
          read_image(folder / ("n_00" + std::string(frame < 10 ? "0" : "") + std::to_string(frame) + ".pfm"));
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const double error = image.data[i] - truth.data[i];
        sum[i] += error / 16;
        one += error * error / 16;
      }
    }
    for (const double error : sum) mean += error * error;
    return std::sqrt(mean / one);
  };
  REQUIRE(run_sundog({"render", folder.file("noisy.json"), "-o", folder.file("truth.pfm"), "--samples",
                      "4096", "--seed", "77"})
              .status == 0);
  const double own = mean_error({}), fixed = mean_error({"--seed", "3"});
  CAPTURE(own, fixed);
  CHECK(own < 0.3);
  CHECK(own > 0.2);
  CHECK(fixed == Approx(1));
}
