// Reports of camera rays that max_depth ends, and seeds.
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

/// The board of least_scene behind `panes` clear disks.
std::string behind_panes(const CliFolder& folder, int panes) {
  nlohmann::json scene = nlohmann::json::parse(least_scene);
  scene["materials"]["pane"] = {{"ambient", 0}, {"diffuse", 0}, {"transmission", 0.9}};
  for (int i = 0; i < panes; ++i)
    scene["objects"].push_back({{"type", "disk"},
                                {"radius", 9},
                                {"center", {0, 0.5, 4 - 0.1 * i}},
                                {"normal", {0, 0.2, 1}},
                                {"material", "pane"}});
  return folder.write("panes.json", scene.dump()).string();
}

CommandResult rendered(const CliFolder& folder, int panes, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"render", behind_panes(folder, panes), "-o", folder.file("a.pfm")};
  words.insert(words.end(), more.begin(), more.end());
  return run_sundog(words);
}

}  // namespace

TEST_CASE(
    "camera rays of whitted that max_depth ends behind panes are reported, and none with a greater one; "
    "paths see through") {
  const CliFolder folder;
  for (const char* integrator : {"whitted", "path"}) {
    INFO(integrator);
    const std::vector<std::string> words = {"--integrator", integrator, "--max-depth"};
    const auto with = [&](const char* depth) {
      std::vector<std::string> all = words;
      all.emplace_back(depth);
      return rendered(folder, 12, all);
    };
    CHECK((with("8").err.find("raise max_depth") != std::string::npos) ==
          (integrator == std::string("whitted")));
    CHECK(with("20").err.empty());
  }
}

TEST_CASE("paths that max_depth ends inside glass are counted, whether shadow rays pass it or not") {
  const CliFolder folder;
  const auto ended = [&](const char* shadow) {
    nlohmann::json scene = nlohmann::json::parse(least_scene);
    scene["materials"]["glass"] = {{"type", "dielectric"}, {"ior", 1.5}, {"shadow", shadow}};
    scene["objects"].push_back(
        {{"type", "sphere"}, {"radius", 1}, {"center", {0, 0.5, 2}}, {"material", "glass"}});
    const std::string file = folder.write("glass.json", scene.dump()).string(), out = folder.file("a.pfm");
    const CommandResult result = run_sundog({"render", file, "-o", out, "--integrator", "path", "--max-depth",
                                             "1", "--stats", folder.file("a.json")});
    REQUIRE(result.status == 0);
    return nlohmann::json::parse(read_file(folder / "a.json"))["counters"]["depth_limit"].get<int>();
  };
  CHECK(ended("opaque") > 0);
  CHECK(ended("filter") == ended("opaque"));
}

TEST_CASE("--seed gives a picture noise of its own, --max-depth any depth to paths alone") {
  const CliFolder folder;
  const auto bytes = [&](const char* seed) {
    REQUIRE(rendered(folder, 1, {"--samples", "2", "--seed", seed}).status == 0);
    return read_file(folder / "a.pfm");
  };
  CHECK(bytes("0") == bytes("0"));
  CHECK(bytes("0") != bytes("5"));
  CHECK(rendered(folder, 1, {"--integrator", "path", "--max-depth", "500"}).status == 0);
  CHECK(rendered(folder, 1, {"--max-depth", "65"}).status == 2);
  CHECK(rendered(folder, 1, {"--seed", "-1"}).status == 2);
}
