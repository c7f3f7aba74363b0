// --isolate: each device in a process of its own, which may crash, hang or be killed.
#include <base/file.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

struct IsolatedFolder : CliFolder {
  std::string plain;
  CommandOptions options;

  IsolatedFolder() {
    options.environment["POCL_DEVICES"] = "basic pthread";
    options.environment["SUNDOG_LAUNCH_LIMIT"] = "3.0";
    REQUIRE(run_sundog(arguments({"--device", "0:1"}), options).status == 0);
    plain = read_file(*this / "a.pfm");
  }
  std::vector<std::string> arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"render",  scene,       "-o", file("a.pfm"), "--size",
                                    "160x120", "--samples", "4",  "--stats",     file("s.json")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  CommandResult render(const std::string& faults, std::vector<std::string> more) {
    options.environment["SUNDOG_FAULTS"] = faults;
    more.push_back("--isolate");
    std::filesystem::remove(*this / "a.pfm");
    return run_sundog(arguments(more), options);
  }
  json stats() const { return json::parse(read_file(*this / "s.json")); }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("devices in processes of their own render the same bits, with AOVs and fixed shares") {
  IsolatedFolder folder;
  const CommandResult result = folder.render("", {"--device", "0:0", "--device", "0:1", "--split", "1,1"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  CHECK(read_file(folder / "a.pfm") == folder.plain);
  for (const json& device : folder.stats()["devices"]) {
    CHECK(device["share"] == 0.5);
    CHECK(device["kernels"]["render_whitted"]["launches"] > 0);
  }
  const auto exr = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"render", folder.scene, "-o",     folder.file(name), "--aov",
                                          "depth",  "--aov",      "normal", "--device",        "0:1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    REQUIRE(run_sundog(arguments, folder.options).status == 0);
    return read_file(folder / name);
  };
  CHECK(exr("a.exr", {}) == exr("b.exr", {"--isolate"}));
}

TEST_CASE("a driver that crashes or hangs takes its worker along, not the frame") {
  IsolatedFolder folder;
  struct Case {
    const char *faults, *says;
  };
  for (const Case& c : {Case{"crash@0:0#2", "was killed by signal 6"}, Case{"hang@0:0#2", "the driver hangs"},
                        Case{"crash@0:0", "; the device was retired"}, Case{"build@0:0", "did not build"}}) {
    CAPTURE(c.faults);
    const CommandResult result =
        folder.render(c.faults, {"--device", "0:0", "--device", "0:1", "--split", "1,1"});
    CAPTURE(result.err);
    CHECK(result.status == 0);
    CHECK(contains(result.err, c.says));
    CHECK(read_file(folder / "a.pfm") == folder.plain);
  }
  CHECK(folder.render("build@0:0", {"--device", "0:0"}).status == 5);
  const CommandResult result = folder.render("crash@0:0", {"--device", "0:0"});
  CHECK(result.status == 4);
  CHECK(contains(result.err, "its worker process was killed by signal 6"));
}

TEST_CASE("a worker killed in the middle of a frame costs time, not the frame") {
  IsolatedFolder folder;
  // The only device, so that the frame needs it. Each worker is killed at its 200th launch, of 300 tiles.
  const CommandResult result = folder.render("kill@0:1#200", {"--device", "0:1", "--tile", "8"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "its worker process was killed by signal 9"));
  CHECK(read_file(folder / "a.pfm") == folder.plain);
  const json stats = folder.stats();
  CHECK(stats["image"]["complete"] == true);
  CHECK(stats["devices"][0]["failures"] == 1);
  CHECK(stats["devices"][0]["retired"] == false);
}

TEST_CASE("the frames of an animation share their workers, and one that dies is replaced") {
  IsolatedFolder folder;
  const std::vector<std::string> animation = {"--device",
                                              "0:1",
                                              "--tile",
                                              "60",
                                              "--set",
                                              R"(/animate=[{"value": "/camera/fov", "type": "linear",
                    "keys": [{"frame": 0, "value": 30}, {"frame": 5, "value": 50}]}])"};
  const auto frames = [&](const std::string& faults, const std::string& list, bool isolate) {
    std::vector<std::string> words = animation;
    words.insert(words.end(), {"--frames", list});
    folder.options.environment["SUNDOG_FAULTS"] = faults;
    if (isolate) words.emplace_back("--isolate");
    const CommandResult result = run_sundog(folder.arguments(words), folder.options);
    CAPTURE(result.err);
    CHECK(result.status == 0);
    std::string bytes;
    for (int frame = 0; frame < 6; ++frame)
      if (const auto file = folder / fmt::format("a_{:04}.pfm", frame); std::filesystem::exists(file)) {
        bytes += read_file(file);
        std::filesystem::remove(file);
      }
    return std::pair(bytes, result.err);
  };
  const std::string plain = frames("", "0..5", false).first;
  CHECK(frames("", "0..5", true) == std::pair(plain, std::string()));
  // A frame of six tiles does not come so far, six frames in one process do.
  const char* late = "kill@0:1#15";
  CHECK(frames(late, "5", true).second.empty());
  const auto [bytes, told] = frames(late, "0..5", true);
  CHECK(contains(told, "its worker process was killed by signal 9"));
  CHECK(bytes == plain);
}

TEST_CASE("a worker that is stopped is noticed by its silence") {
  IsolatedFolder folder;
  folder.options.environment["SUNDOG_SILENCE_LIMIT"] = "1.5";
  const CommandResult result =
      folder.render("stop@0:0#2", {"--device", "0:0", "--device", "0:1", "--split", "1,1"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "its worker process had not been heard of for "));
  CHECK(contains(result.err, "and was ended"));
  CHECK(read_file(folder / "a.pfm") == folder.plain);
}

TEST_CASE("an interrupt reaches the workers") {
  IsolatedFolder folder;
  folder.options.terminal = true;
  folder.options.environment["TERM"] = "xterm";
  folder.options.signal_at = "Mpixel/s";
  const CommandResult result = run_sundog(
      folder.arguments({"--isolate", "--device", "0:1", "--set", "/render/samples=20000", "--tile", "8"}),
      folder.options);
  CAPTURE(result.err);
  CHECK(result.status == 130);
  CHECK(contains(result.err, "interrupted: "));
  // The worker gave its tile back and told what it did; it was not waited for in vain, nor ended.
  const json stats = folder.stats();
  CHECK(stats["image"]["complete"] == false);
  CHECK(stats["devices"][0]["failures"] == 0);
  CHECK(stats["devices"][0]["kernels"]["render_whitted"]["launches"] > 0);
}

TEST_CASE("worker is no command for people") {
  const CommandResult result = run_sundog({"worker"});
  CHECK(result.status == 2);
  CHECK(contains(result.err, "--isolate"));
  CHECK_FALSE(contains(run_sundog({"--help"}).out, "worker  "));
}
