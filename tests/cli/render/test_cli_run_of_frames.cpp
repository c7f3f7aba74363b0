// A run of frames: which of them are done, what is rendered again, and who renders it.
#include <base/file.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

/// A scene whose camera goes up from frame to frame.
struct Run : CliFolder {
  json scene = json::parse(small_scene);
  std::vector<std::string> options;  // of every command

  Run() {
    scene["animate"] = json::parse(R"([{"type": "linear", "value": "/camera/position/1", "keys": [
      {"frame": 0, "value": 1}, {"frame": 2, "value": 2}, {"frame": 4, "value": 3}]}])");
  }

  std::vector<std::string> command(const std::string& frames,
                                   const std::vector<std::string>& more = {}) const {
    write("moving.json", scene.dump());
    std::vector<std::string> all{"render", file("moving.json"), "-o", file("a.png"), "--frames", frames};
    all.insert(all.end(), options.begin(), options.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::string picture(int frame) const {
    return read_file(*this / ("a_000" + std::to_string(frame) + ".png"));
  }
};

/// The frames that a command has rendered, in their order.
std::string rendered(const CommandResult& result) {
  REQUIRE(result.status == 0);
  std::string frames;
  for (std::size_t at = 0; (at = result.out.find("a_000", at)) != std::string::npos; at += 5)
    frames += result.out[at + 5];
  return frames;
}

struct ResumedRun : Run {
  ResumedRun() { options = {"--resume", file("r")}; }
};

}  // namespace

TEST_CASE("lists, steps and ranges that fall say which frames are rendered, and in which order") {
  const Run run;
  CHECK(rendered(run_sundog(run.command("4,0..2,1"))) == "4012");
  CHECK(rendered(run_sundog(run.command("4..0", {"--step", "2"}))) == "420");
}

TEST_CASE("frames that are drawn while others are loaded and saved have the bits of each alone") {
  Run run;
  run.options = {"--size", "640x480", "--samples", "1"};
  CHECK(rendered(run_sundog(run.command("0..4"))) == "01234");
  std::vector<std::string> together;
  for (int frame = 0; frame < 5; ++frame) together.push_back(run.picture(frame));
  for (int frame = 0; frame < 5; ++frame) {
    CHECK(rendered(run_sundog(run.command(std::to_string(frame)))) == std::to_string(frame));
    CHECK((run.picture(frame) == together[static_cast<std::size_t>(frame)]));
  }
}

TEST_CASE("a frame that cannot be saved ends the run, and those before it are done") {
  ResumedRun run;
  run.options.insert(run.options.end(), {"--size", "640x480", "--samples", "1"});
  std::filesystem::create_directories(run / "a_0003.png" / "in_the_way");
  const CommandResult result = run_sundog(run.command("0..4"));
  CAPTURE(result.out, result.err);
  CHECK(result.status != 0);
  CHECK(result.err.find("a_0003.png") != std::string::npos);
  std::filesystem::remove_all(run / "a_0003.png");
  CHECK(rendered(run_sundog(run.command("0..4"))) == "34");
}

TEST_CASE("a frame is rendered again when its own keys change, and only then, also after the run has ended") {
  ResumedRun run;
  CHECK(rendered(run_sundog(run.command("0..4"))) == "01234");
  const CommandResult again = run_sundog(run.command("0..4"));
  CHECK(rendered(again) == "");
  CHECK(again.out.find("5 frames in ") == 0);
  CHECK(again.out.find("0 rendered, 5 were done") != std::string::npos);
  run.scene["animate"][0]["keys"][2]["value"] = 4;
  CHECK(rendered(run_sundog(run.command("0..4"))) == "34");
  CHECK(rendered(run_sundog(run.command("0..4"))) == "");
}

TEST_CASE("a frame counts as done by all that shaped its file") {
  ResumedRun run;
  REQUIRE(rendered(run_sundog(run.command("0..1"))) == "01");
  const std::vector<std::string> more =
      GENERATE(std::vector<std::string>{"--exposure", "1"}, std::vector<std::string>{"--tone-map", "agx"},
               std::vector<std::string>{"--no-dither"}, std::vector<std::string>{"--metadata"},
               std::vector<std::string>{"--white-balance", "4000"});
  CHECK(rendered(run_sundog(run.command("0..1", more))) == "01");
  CHECK(rendered(run_sundog(run.command("0..1", more))) == "");
  run.scene["image"]["tone_map"] = {{"exposure", -2}};
  CHECK(rendered(run_sundog(run.command("1"))) == "1");
}

TEST_CASE("an empty picture and one that is cut off are not done") {
  const ResumedRun run;
  REQUIRE(rendered(run_sundog(run.command("0..2"))) == "012");
  const std::string whole = run.picture(1);
  run.write("a_0000.png", "");
  run.write("a_0001.png", whole.substr(0, whole.size() / 2));
  std::filesystem::remove(run / "a_0002.png");
  CHECK(rendered(run_sundog(run.command("0..2"))) == "012");
  CHECK(run.picture(1) == whole);
}

TEST_CASE("frames whose picture is there are left alone on demand") {
  const Run run;
  run.write("a_0000.png", "somebody's work");
  run.write("a_0001.png", "");
  CHECK(rendered(run_sundog(run.command("0..2", {"--skip-existing"}))) == "12");
  CHECK(run.picture(0) == "somebody's work");
}

TEST_CASE("a run under a time limit gets to its last frame, and is continued until all are whole") {
  ResumedRun run;
  run.options.insert(run.options.end(), {"--samples", "512"});
  const CommandResult first = run_sundog(run.command("0..1", {"--time-limit", "0.001"}));
  CAPTURE(first.out, first.err);
  CHECK(rendered(first).find("01") != std::string::npos);
  CHECK(first.out.find("unfinished, ended by the time limit: 0, 1; the same command continues them") !=
        std::string::npos);
  CHECK(std::filesystem::exists(run / "r_0000"));
  CHECK(std::filesystem::exists(run / "r_0001"));
  const std::vector<std::string> patient = run.command("0..1", {"--time-limit", "1000"});
  CHECK(rendered(run_sundog(patient)) == "01");
  CHECK_FALSE(std::filesystem::exists(run / "r_0000"));
  const std::string continued = run.picture(1);
  CHECK(rendered(run_sundog(patient)) == "");
  std::filesystem::remove(run / "a_0001.png");
  CHECK(rendered(run_sundog(patient)) == "1");
  CHECK(run.picture(1) == continued);
}

TEST_CASE("checkpoints that do not fit a frame are left, with a warning, and the frame begins anew") {
  ResumedRun run;
  REQUIRE(rendered(run_sundog(run.command("0"))) == "0");
  const std::string whole = run.picture(0);
  std::filesystem::remove(run / "a_0000.png");
  const bool damaged = GENERATE(true, false);
  if (damaged) {
    run.write("r_0000", "no checkpoint");
  } else {  // of the scene as it was
    run.scene["camera"]["fov"] = 20;
    REQUIRE(run_sundog(run.command("0", {"--samples", "512", "--time-limit", "0.001"})).status == 0);
    REQUIRE(std::filesystem::exists(run / "r_0000"));
    run.scene["camera"]["fov"] = 40;
  }
  const CommandResult result = run_sundog(run.command("0"));
  CHECK(rendered(result) == "0");
  CHECK(result.err.starts_with("sundog: warning: " + run.file("r_0000") + ": is "));
  CHECK(result.err.ends_with("; the frame began anew\n"));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(run.picture(0) == whole);
  CHECK_FALSE(std::filesystem::exists(run / "r_0000"));
}

TEST_CASE("a list of frames that is none is set aside, and damaged lines cost their frames alone") {
  const ResumedRun run;
  REQUIRE(rendered(run_sundog(run.command("0..1"))) == "01");
  const std::string list = read_file(run / "r.frames");
  SECTION("no list") {
    const std::string damage = GENERATE("{", "[]", "\x01\x02", R"({"schema": 1, "frames": {"0": 3}})");
    run.write("r.frames", damage);
    const CommandResult result = run_sundog(run.command("0..1"));
    CHECK(rendered(result) == "01");
    CHECK(result.err.starts_with("sundog: warning: " + run.file("r.frames") + ": is no list "));
    CHECK(read_file(run / "r.frames.damaged") == damage);
  }
  SECTION("a line that was cut off") {
    run.write("r.frames", list.substr(0, list.size() - 9));
    const CommandResult result = run_sundog(run.command("0..1"));
    CHECK(rendered(result) == "1");
    CHECK(result.err.find("1 of its lines is damaged") != std::string::npos);
  }
  CHECK(rendered(run_sundog(run.command("0..1"))) == "");
}

TEST_CASE("two processes with one --resume share the frames, and both wait for the last one") {
  const ResumedRun run;
  static_cast<void>(run.command("0"));  // writes the scene
  const char* both = R"("$0" render moving.json -o a.png --frames 0..4 --resume r --samples 64 >one &
                        "$0" render moving.json -o a.png --frames 4..0 --resume r --samples 64 >two; wait $!)";
  CommandOptions options;
  options.folder = run.path();
  CommandResult result = run_command({"sh", "-c", both, SUNDOG_BINARY}, options);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  result.out = read_file(run / "one") + read_file(run / "two");
  std::string all = rendered(result);
  std::ranges::sort(all);
  CHECK(all == "01234");
  CHECK(rendered(run_sundog(run.command("0..4", {"--samples", "64"}))) == "");
}

TEST_CASE("all frames are checked before the first is rendered") {
  Run run;
  run.scene["animate"] = json::parse(R"([
    {"type": "linear", "value": "/camera/fov", "keys": [{"frame": 0, "value": 30}]},
    {"type": "linear", "value": "/objects/1/radius", "keys": [{"frame": 0, "value": 1}, {"frame": 4, "value": -1}]}])");
  const CommandResult result = run_sundog(run.command("0..3"));
  CHECK(result.status == 3);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find("moving.json: /objects/1/radius: ") != std::string::npos);
  CHECK(result.err.find("(in frame 2, moved by /animate/1)") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(run / "a_0000.png"));
}

TEST_CASE("a run shows how far it is, and what is left of it") {
  const Run run;
  CommandOptions options;
  options.terminal = true;
  options.environment["TERM"] = "xterm";
  const CommandResult result = run_sundog(run.command("0..2"), options);
  REQUIRE(result.status == 0);
  CHECK(result.err.find(" frame 2/3 ") != std::string::npos);
  CHECK(result.out.find("  frame 1 of 3, about ") != std::string::npos);
  CHECK(result.out.find("  frame 3 of 3") == std::string::npos);
  CHECK(result.out.find("3 frames in ") != std::string::npos);
}
