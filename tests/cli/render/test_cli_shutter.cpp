// Frames whose shutter is open for a while: the mean of stills.
#include <base/image_io.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

constexpr int steps = 8;

/// The scene, in which much moves from one frame to another.
std::string moving(const CliFolder& folder, const std::string& name, double first, double last) {
  json scene = json::parse(small_scene);
  scene["animate"] = json::array();
  scene["objects"].push_back({{"type", "sphere"},
                              {"name", "ball"},
                              {"radius", 0.5},
                              {"material", scene["materials"].begin().key()},
                              {"center", {0, 0, 1}}});
  scene["lights"].push_back({{"type", "point"}, {"name", "lamp"}, {"position", {0, 4, 2}}, {"intensity", 1}});
  const auto add = [&](const char* value, const json& from, const json& to) {
    scene["animate"].push_back(
        {{"type", "linear"},
         {"value", value},
         {"keys", {{{"frame", first}, {"value", from}}, {{"frame", last}, {"value", to}}}}});
  };
  add("/camera/fov", 30, 40);
  add("/objects/ball/center", {-1, 0, 1}, {1, 0.5, 1});
  add("/lights/lamp/intensity", 0.2, 2);
  return folder.write(name, scene.dump()).string();
}

Image picture(const CliFolder& folder, const std::string& scene, const std::string& frames,
              const std::vector<std::string>& more, const std::string& name) {
  std::vector<std::string> arguments{"render", scene, "-o", folder.file("f.pfm"), "--frames", frames};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const CommandResult result = run_sundog(arguments);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  return read_image(folder / name);
}

}  // namespace

TEST_CASE("an open shutter sees the mean of what tracks move: objects, lights, the camera") {
  const CliFolder folder;
  // One frame from 0 to 1 in the film, and eight from 0 to 8 of stills at the middles of its eighths.
  const std::string film = moving(folder, "film.json", 0, 1),
                    stills = moving(folder, "stills.json", -0.5, 7.5);
  const Image blurred = picture(folder, film, "0",
                                {"--samples", "8", "--set", "/camera/shutter=1", "--set",
                                 fmt::format("/camera/shutter_steps={}", steps)},
                                "f_0000.pfm");
  std::vector<double> mean(blurred.data.size());
  for (int k = 0; k < steps; ++k) {
    const Image still =
        picture(folder, stills, std::to_string(k), {"--samples", "1"}, fmt::format("f_{:04}.pfm", k));
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += static_cast<double>(still.data[i]) / steps;
  }
  double worst = 0;
  for (std::size_t i = 0; i < mean.size(); ++i)
    worst = std::max(worst, std::abs(mean[i] - static_cast<double>(blurred.data[i])));
  CHECK(worst < 1e-5);
  const Image sharp = picture(folder, film, "0", {"--samples", "1"}, "f_0000.pfm");
  CHECK(sharp.data != blurred.data);
}

TEST_CASE("a run of blurred frames renders those anew whose open shutter sees another key") {
  const CliFolder folder;
  const std::string scene = moving(folder, "film.json", 0, 1);
  const auto run = [&](const std::string& setting) {
    const CommandResult result = run_sundog({"render", scene, "-o", folder.file("g.pfm"), "--frames", "0..1",
                                             "--resume", folder.file("r"), "--set", "/camera/shutter=0.5",
                                             "--set", "/camera/shutter_steps=2", "--set", setting});
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    return result.out;
  };
  CHECK_THAT(run("/render/samples=2"), ContainsSubstring("2 rendered, 0 were done"));
  CHECK_THAT(run("/render/samples=2"), ContainsSubstring("0 rendered, 2 were done"));
  CHECK_THAT(run("/animate/2/keys/1/value=4"), ContainsSubstring("2 rendered"));
}

TEST_CASE("worker processes blur the frames of an open shutter to the same bits") {
  const CliFolder folder;
  const std::string scene = moving(folder, "film.json", 0, 1);
  const std::vector<std::string> open = {"--samples",           "6",     "--set",
                                         "/camera/shutter=0.5", "--set", "/camera/shutter_steps=3"};
  std::vector<std::string> isolated = open;
  isolated.emplace_back("--isolate");
  const Image plain = picture(folder, scene, "0..1", open, "f_0001.pfm");
  CHECK(picture(folder, scene, "0..1", isolated, "f_0001.pfm").data == plain.data);
}
