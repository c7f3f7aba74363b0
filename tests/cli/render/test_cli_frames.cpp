// Animations: numbered files, an image a frame, continued after an interruption.
#include <base/file.h>
#include <base/image_compare.h>
#include <base/image_io.h>

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
  const json first = json::parse(read_file(folder / "s_0001.json")),
             second = json::parse(read_file(folder / "s_0002.json"));
  CHECK(first["image"]["file"] == folder.file("f00001.pfm"));
  CHECK(second["kernels_cached"] == true);  // the device stays open
}

TEST_CASE("a resumed animation renders only the frames that are not done, and those that have changed") {
  const CliFolder folder;
  const std::string log = folder.file("r.frames");
  REQUIRE(render_frames(folder, "a.png", "0..0").status == 0);
  const std::string done = read_file(folder / "a_0000.png");
  folder.write("r.frames", R"({"schema": 1, "frames": {"0": "0123456789abcdef"}})");  // of another scene
  folder.write("a_0000.png", "old");
  REQUIRE(render_frames(folder, "a.png", "0..1", {"--resume", folder.file("r")}).status == 0);
  CHECK(read_file(folder / "a_0000.png") == done);
  CHECK(!std::filesystem::exists(log));  // all are done
}

TEST_CASE("a damaged list of frames is set aside, and the animation resumes from its pictures") {
  const CliFolder folder;
  const std::string damage =
      GENERATE("", "{", "[]", "\x01\x02", R"({"schema": 1})", R"({"frames": {}})",
               R"({"schema": 1, "frames": {"x": "1"}})", R"({"schema": "one", "frames": {"0": 3}})");
  CAPTURE(damage);
  REQUIRE(render_frames(folder, "a.png", "0..1").status == 0);
  const std::string first = read_file(folder / "a_0000.png"), second = read_file(folder / "a_0001.png");
  folder.write("a_0000.png", second);  // whole: of another look, to be known by it
  folder.write("a_0001.png", second.substr(0, second.size() / 2));  // not whole
  folder.write("r.frames", damage);
  // Written before the pictures, as a scene is.
  const std::string scene = folder.file("moving.json");
  const CommandResult result = run_sundog(
      {"render", scene, "-o", folder.file("a.png"), "--frames", "0..2", "--resume", folder.file("r")});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.err.starts_with("sundog: warning: " + folder.file("r.frames") + ": "));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(read_file(folder / "r.frames.damaged") == damage);
  CHECK(read_file(folder / "a_0000.png") == second);
  CHECK(read_file(folder / "a_0001.png") == second);
  CHECK(std::filesystem::exists(folder / "a_0002.png"));
  CHECK_FALSE(std::filesystem::exists(folder / "r.frames"));
}

TEST_CASE("pictures older than the scene do not count as done where the list of frames is damaged") {
  const CliFolder folder;
  REQUIRE(render_frames(folder, "a.png", "0..0").status == 0);
  const std::string first = read_file(folder / "a_0000.png");
  folder.write("a_0000.png", read_file(folder / "a_0000.png") + "more");
  std::filesystem::last_write_time(
      folder / "a_0000.png",
      std::filesystem::last_write_time(folder / "moving.json") - std::chrono::hours(1));
  folder.write("r.frames", "{");
  REQUIRE(run_sundog({"render", folder.file("moving.json"), "-o", folder.file("a.png"), "--frames", "0",
                      "--resume", folder.file("r")})
              .status == 0);
  CHECK(read_file(folder / "a_0000.png") == first);
}

TEST_CASE("frames that cannot be are refused") {
  const CliFolder folder;
  for (const char* frames : {"x", "3..1", "1..", "-1..2", "1...2", "1e3", "99999999"})
    CHECK(render_frames(folder, "a.png", frames).status == 2);
  const CommandResult still =
      run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--frames", "0..1"});
  CHECK(still.status == 3);
  CHECK(is_one_error_line(still.err));
  CHECK(still.err.find("animate") != std::string::npos);
}
