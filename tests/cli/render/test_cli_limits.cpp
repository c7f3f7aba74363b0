// Options that cannot be honoured are refused, not ignored, and never crash the driver.
#include <base/file.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

TEST_CASE("--float is refused for a format that cannot keep it") {
  const CliFolder folder;
  for (const std::string name : {"a.png", "a.hdr", "a.pfm"}) {
    const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file(name), "--float"});
    CHECK(result.status == 2);
    CHECK(result.err.find(".exr") != std::string::npos);
  }
}

TEST_CASE("a work-group of two dimensions is launched as one") {
  const CliFolder folder;
  const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file("a.pfm"), "--work-group",
                                           "4x2", "--stats", folder.file("s.json")});
  REQUIRE(result.status == 0);
  const json stats = json::parse(read_file(folder / "s.json"));
  CHECK(stats["devices"][0]["kernels"]["render_whitted"]["work_group"] == json({4, 2}));
}

TEST_CASE("a work-group that would overflow a thread's stack is refused") {
  const CliFolder folder;
  for (const std::string size : {"4096", "64x64", "2048"}) {
    const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file("a.pfm"),
                                             "--max-depth", "64", "--device", "cpu", "--work-group", size});
    CAPTURE(size, result.err);
    CHECK(result.status == 2);
    CHECK(result.err.find("work-group") != std::string::npos);
  }
}

TEST_CASE("the driver may choose a work-group of any size without overflowing a thread's stack") {
  const CliFolder folder;
  for (const std::string device : {"pthread", "basic"}) {
    CommandOptions options;
    options.environment["POCL_DEVICES"] = device;
    const CommandResult result =
        run_sundog({"render", folder.scene, "-o", folder.file("a.pfm"), "--device", "portable", "--size",
                    "256x256", "--tile", "256", "--max-depth", "20", "--work-group", "driver", "--verbose",
                    "--stats", folder.file("s.json")},
                   options);
    CAPTURE(device, result.err);
    CHECK(result.status == 0);
    CHECK(result.out.find("work-group chosen by the driver") != std::string::npos);
    const json stats = json::parse(read_file(folder / "s.json"));
    CHECK(stats["devices"][0]["kernels"]["render_whitted"]["work_group"] == "driver");
  }
}
