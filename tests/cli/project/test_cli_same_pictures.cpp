// bench/same_pictures.sh on a tiny scene: a build against itself, and against builds that differ from it.
#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

namespace fs = std::filesystem;

namespace {

struct Builds : CliFolder {
  /// A build folder whose `render` is the real one with `what` before or behind its arguments.
  std::string build(const std::string& name, const std::string& what) const {
    fs::permissions(write(name + "/sundog",
                          "#!/bin/bash\n[[ $1 == render ]] && " + what + "\nexec " SUNDOG_BINARY " \"$@\"\n"),
                    fs::perms::owner_all);
    return file(name);
  }
  CommandResult compare(const std::string& other,
                        const std::vector<std::string>& more = {"--no-times"}) const {
    std::vector<std::string> command{SUNDOG_SOURCE_DIR "/bench/same_pictures.sh",
                                     "--size",
                                     "16x12",
                                     "--scenes",
                                     scene,
                                     "--devices",
                                     "portable"};
    command.insert(command.end(), more.begin(), more.end());
    command.insert(command.end(), {SUNDOG_BINARY, other});
    return run_command(command);
  }
};

}  // namespace

TEST_CASE("same_pictures.sh finds a build the same as itself, and times both") {
  const Builds builds;
  // The script starts both builds at once: without this, each would compile the kernels.
  REQUIRE(run_sundog({"render", builds.scene, "-o", builds.file("first.exr"), "--device", "portable", "--aov",
                      "rays", "--aov", "uv", "--quiet"})
              .status == 0);
  const CommandResult result = builds.compare(fs::path(SUNDOG_BINARY).parent_path().string(),
                                              {"--repeat", "1", "--time-size", "16x16"});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("the same\n1 the same, 0 differ, 0 not compared\n") &&
                             ContainsSubstring("new/old") && ContainsSubstring("geometric mean"));
}

TEST_CASE("same_pictures.sh notices what a build does differently") {
  const Builds builds;
  const auto [change, expected] = GENERATE(table<std::string, std::string>({
      {"set -- \"$@\" --set /image/background=[0.2,0.4,0.9]", "DIFFERS: pictures differ: "},
      {"set -- \"$@\" --set /render/cutoff=0.5", "cut_off "},
      {"set -- \"$@\" --set '/objects=[{\"type\": \"sphere\", \"material\": \"glass\"}, {\"type\": "
       "\"plane\", "
       "\"point\": [0, -1, 0], \"material\": \"floor\"}]'",
       "DIFFERS: AOVs differ\n"},
      {"{ echo broken >&2; exit 5; }", "DIFFERS: the new build fails (status 5): broken\n"},
  }));
  const CommandResult result = builds.compare(builds.build("other", change));
  CAPTURE(change, result.out, result.err);
  CHECK(result.status == 6);
  CHECK_THAT(result.out,
             ContainsSubstring(expected) && ContainsSubstring("0 the same, 1 differ, 0 not compared\n"));
}

TEST_CASE("same_pictures.sh skips a device that is not there") {
  const Builds builds;
  const CommandResult result = builds.compare(SUNDOG_BINARY, {"--no-times", "--devices", "no such device"});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 1);
  CHECK_THAT(result.err, ContainsSubstring("skipped: there is no device no such device here"));
}

TEST_CASE("same_pictures.sh says how it is used") {
  CHECK_THAT(run_command({SUNDOG_SOURCE_DIR "/bench/same_pictures.sh", "--help"}).out,
             ContainsSubstring("OLD_BUILD NEW_BUILD"));
  CHECK(run_command({SUNDOG_SOURCE_DIR "/bench/same_pictures.sh", SUNDOG_BINARY}).status == 2);
  CHECK(run_command({SUNDOG_SOURCE_DIR "/bench/same_pictures.sh", SUNDOG_BINARY, "nowhere"}).status == 2);
}
