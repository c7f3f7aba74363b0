// render --draft: a preview by kernels that all scenes share.
#include <nlohmann/json.hpp>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"
#include "scene/json/parse.h"

using namespace sundog;
using nlohmann::json;

TEST_CASE(
    "a draft compiles nothing after an edit, is shown while kernels are built, and differs in few pixels") {
  CliFolder folder;
  CommandOptions options;
  options.environment = {{"XDG_CACHE_HOME", folder.file("cache")}, {"POCL_CACHE_DIR", folder.file("pocl")}};
  const auto render = [&](const std::string& scene, const char* out, std::vector<std::string> more) {
    std::vector<std::string> words = {"render",  folder.write("edited.json", scene).string(),
                                      "-o",      folder.file(out),
                                      "--stats", folder.file("s.json")};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = run_sundog(words, options);
    INFO(result.err);
    REQUIRE(result.status == 0);
    return json::parse(read_file(folder / "s.json"));
  };
  render(small_scene, "first.pfm", {"--draft"});
  // A spot for the lamp, a texture on the floor, another solid, a coat over gold.
  std::string edited = small_scene;
  const auto replace = [&](std::string_view from, std::string_view to) {
    REQUIRE(edited.find(from) != std::string::npos);
    edited.replace(edited.find(from), from.size(), to);
  };
  replace(R"({"type": "point", "position": [-3, 5, 4]})",
          R"({"type": "spot", "position": [-3, 5, 4], "direction": [3, -5, -4], "intensity": 3})");
  replace(R"({"color": [0.8, 0.8, 0.8]})", R"({"color": "smudges"})");
  replace(R"({"type": "sphere", "material": "glass"})",
          R"({"type": "sphere", "material": "glass"}, {"type": "torus", "material": "car_paint"})");
  CHECK(render(edited, "draft.pfm", {"--draft"})["devices"][0]["kernels_cached"] == true);
  // While the picture's own kernels are built, a draft is shown; it leaves nothing in the picture.
  const json built = render(edited, "shown.pfm", {"--write-every", "0.05"});
  CHECK(built["kernels_cached"] == false);
  CHECK(built["draft_pictures"] > 0);
  CHECK(render(edited, "picture.pfm", {"--write-every", "0.05"})["draft_pictures"] == 0);
  CHECK(read_file(folder / "shown.pfm") == read_file(folder / "picture.pfm"));
  const Image draft = read_image(folder / "draft.pfm"), picture = read_image(folder / "picture.pfm");
  std::size_t differ = 0;
  for (std::size_t i = 0; i < picture.data.size(); ++i)
    differ += std::abs(draft.data[i] - picture.data[i]) > 1e-3f;
  CHECK(differ < picture.data.size() / 50);
}

TEST_CASE("a draft is refused where other parts or passes would join it") {
  CliFolder folder;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--isolate"}, {"--tiles", "1/2"}, {"--resume", folder.file("c")}}) {
    std::vector<std::string> words = {"render", folder.scene, "-o", folder.file("a.png"), "--draft"};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = run_sundog(words);
    CHECK(result.status == 2);
    CHECK_THAT(result.err, ContainsSubstring("--draft makes a preview"));
  }
}
