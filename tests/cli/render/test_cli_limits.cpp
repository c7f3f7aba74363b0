// Options that cannot be honoured are refused, not ignored, and never crash the driver.
#include <base/file.h>
#include <base/image_io.h>

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

TEST_CASE("a picture that is too large for its format is refused before the render") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.jpg"), "--size", "65536x4"});
  CHECK(result.status == 2);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find("a.jpg: 65536x4 pixels are too many") != std::string::npos);
  CHECK(result.err.find("use .png or .exr") != std::string::npos);
  const auto render = [&](const char* name) {
    return run_sundog({"render", folder.scene, "-o", folder.file(name), "--size", "65536x2", "-q"});
  };
  for (const char* name : {"a.png", "a.exr", "a.hdr"}) {
    CHECK(render(name).status == 0);
    CHECK(read_image(folder / name).width == 65536);
  }
}

TEST_CASE("what half floats cut off is said, with the mend") {
  const CliFolder folder;
  std::vector<std::string> command = {"render",
                                      folder.scene,
                                      "-o",
                                      folder.file("a.exr"),
                                      "--quiet",
                                      "--set",
                                      "/image/background=[1e5, 2e4, 3e5]"};
  const CommandResult halves = run_sundog(command);
  CHECK(halves.status == 0);
  CHECK(is_one_error_line(halves.err));
  CHECK(halves.err.find("are brighter than 65504") != std::string::npos);
  CHECK(halves.err.find("--float") != std::string::npos);
  command.emplace_back("--float");
  CHECK(run_sundog(command).err.empty());
  CHECK(read_image(folder / "a.exr").pixel(0, 0)[2] == 3e5f);
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
