// What goes wrong with devices, drivers and disks costs time, not the frame. The faults are asked for by
// SUNDOG_FAULTS (host/base/faults.h).
#include <base/file.h>
#include <base/image_io.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

/// A folder whose renders have two devices, PoCL's "basic" (0:0) and "pthread" (0:1), which compute the same
/// bits.
struct FaultyFolder : CliFolder {
  CommandOptions options;
  FaultyFolder() { options.environment["POCL_DEVICES"] = "basic pthread"; }

  std::string size = "160x120";
  CommandResult render(const std::string& faults, const std::vector<std::string>& more = {}) {
    options.environment["SUNDOG_FAULTS"] = faults;
    std::vector<std::string> arguments = {"render",  scene,          "-o",        file("a.pfm"),
                                          "--size",  size,           "--samples", "4",
                                          "--stats", file("s.json"), "--device",  "portable comp"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sundog(arguments, options);
  }
  std::string plain() {
    const CommandResult result = render("");
    REQUIRE(result.status == 0);
    CHECK(result.err.empty());
    return read_file(*this / "a.pfm");
  }
  json stats() const { return json::parse(read_file(*this / "s.json")); }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("two devices share a frame, and the statistics tell each one's part") {
  FaultyFolder folder;
  folder.plain();
  const json stats = folder.stats();
  REQUIRE(stats["devices"].size() == 2);
  CHECK(stats["devices"][0]["share"].get<double>() + stats["devices"][1]["share"].get<double>() == Approx(1));
  CHECK(stats["efficiency"] > 0);
  CHECK(stats["efficiency"] <= 1.0001);
}

TEST_CASE("one of two devices fails, and the frame has the same bits and status 0") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  struct Case {
    const char *faults, *says;
    bool retired;
  };
  const Case cases[] = {
      {"build@0:1", "did not build", true},
      {"launch=-9999@0:1", "OpenCL status -9999 (3 times); the device was retired", true},
      {"launch=-9999@0:1#2", "", false},  // once, in the middle
      {"launch=-5@0:1", "CL_OUT_OF_RESOURCES", true},
      {"alloc=-4@0:1", "CL_MEM_OBJECT_ALLOCATION_FAILURE (3 times); the device was retired", true},
      {"alloc=-4@0:1#2", "", false},  // once, while the scene is taken there
      {"launch=-6@0:1#3", "", false},
  };
  for (const Case& c : cases) {
    CAPTURE(c.faults);
    // Fixed shares, so that each device has work however fast the other is.
    const CommandResult result = folder.render(c.faults, {"--split", "1,1"});
    CAPTURE(result.err);
    CHECK(result.status == 0);
    CHECK(contains(result.err, c.says));
    CHECK(read_file(folder / "a.pfm") == plain);
    CHECK(folder.stats()["devices"][1]["retired"] == c.retired);
    CHECK(folder.stats()["devices"][0]["retired"] == false);
  }
}

TEST_CASE("a work-group that is too large for the device is made smaller, and the picture is the same") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  // CL_INVALID_WORK_GROUP_SIZE; CL_OUT_OF_RESOURCES, as some drivers say instead.
  const auto [fault, group, note] =
      GENERATE(std::tuple{"group=-54>3@0:1", "16", "work-groups of at most 2 from here on"},
               std::tuple{"group=-54>3@0:1", "4x4", "work-groups of at most 2 from here on"},
               std::tuple{"group=-5>64@0:1", "128", "work-groups of at most 64 from here on"});
  CAPTURE(fault, group);
  const CommandResult result = folder.render(fault, {"--device", "!0:0", "--work-group", group, "--verbose"});
  CAPTURE(result.err, result.out);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);
  CHECK(contains(result.out, note));
  const json device = folder.stats()["devices"][0];
  CHECK(device["failures"] == 0);
  CHECK(device["retired"] == false);
}

TEST_CASE("a kernel's own limit bounds its work-groups, and a larger one is refused by name") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  CommandResult result = folder.render("limit=2@0:1", {"--device", "!0:0"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);
  CHECK(folder.stats()["devices"][0]["kernels"]["render_whitted"]["work_group"].dump().find("4") ==
        std::string::npos);
  result = folder.render("limit=2@0:1", {"--device", "!0:0", "--work-group", "4"});
  CHECK(result.status == 2);
  CHECK(contains(result.err, "a work-group of 4 is more than the 2 that it can have"));
}

TEST_CASE("where resources do not suffice, launches are made smaller until they do") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  const int status = GENERATE(-4, -5, -6);
  const CommandResult result =
      folder.render("launch=" + std::to_string(status) + ">40@0:1", {"--device", "!0:0", "--verbose"});
  CAPTURE(result.err, result.out);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);
  CHECK(contains(result.out, "launches of at most"));
  const json device = folder.stats()["devices"][0];
  CHECK(device["failures"] == 0);
  CHECK(device["retired"] == false);
  CHECK_FALSE(device["notes"].empty());
}

TEST_CASE(
    "loops that a driver ends early are noticed: fewer samples a launch, then other devices, then status 4") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  CommandResult result = folder.render("cut>1@0:1", {"--device", "!0:0"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);
  json device = folder.stats()["devices"][0];
  CHECK(device["failures"] == 0);
  CHECK(contains(device["notes"].dump(), "launches of at most 1 samples"));

  result = folder.render("cut@0:1", {"--split", "1,1"});
  CHECK(result.status == 0);
  CHECK(contains(result.err, "the driver ends the kernel's loops too early"));
  CHECK(read_file(folder / "a.pfm") == plain);
  CHECK(folder.stats()["devices"][1]["retired"] == true);

  result = folder.render("cut@0:1", {"--device", "!0:0"});
  CHECK(result.status == 4);
  CHECK(is_one_error_line(result.err));
  CHECK(contains(result.err, "the driver ends the kernel's loops too early (0 of "));
}

TEST_CASE("a launch that never ends does not hold up a frame that others can finish") {
  FaultyFolder folder;
  folder.size = "800x600";  // large enough for both devices to take part
  const std::string plain = folder.plain();
  const CommandResult result = folder.render("hang@0:0#2");
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);
  // The other device took its tile over: nobody waited until the hanging one was retired.
  const json device = folder.stats()["devices"][0];
  CHECK(device["retired"] == false);
  CHECK(device["abandoned"] == true);
}

TEST_CASE("a launch that never ends is given up after its limit, also in a fixed split") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  folder.options.environment["SUNDOG_LAUNCH_LIMIT"] = "2";
  const CommandResult result = folder.render("hang@0:0#2", {"--split", "1,1"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "the driver hangs; the device was retired"));
  CHECK(read_file(folder / "a.pfm") == plain);
  CHECK(folder.stats()["devices"][0]["abandoned"] == true);
}

TEST_CASE("when every device fails the part that is done is saved, and a checkpoint goes on from it") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  folder.options.environment["SUNDOG_LAUNCH_LIMIT"] = "2";
  const std::vector<std::string> more = {"--device", "!0:0", "--tile", "40", "--resume", folder.file("c")};
  CommandResult result = folder.render("hang@0:1#6", more);
  CAPTURE(result.err);
  CHECK(result.status == 4);
  CHECK(contains(result.err, "every device failed: "));
  CHECK(contains(result.err, "% of the pixels are in " + folder.file("a.pfm")));
  REQUIRE(std::filesystem::exists(folder / "c"));
  CHECK(read_file(folder / "a.pfm") != plain);
  result = folder.render("", more);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);
  CHECK_FALSE(std::filesystem::exists(folder / "c"));
  CHECK(folder.render("build@0:1", {"--device", "!0:0"}).status == 5);
}

TEST_CASE("an image for which the disk has no room is kept elsewhere, with status 1") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  std::filesystem::create_directory(folder / "tmp");
  folder.options.environment["TMPDIR"] = folder.file("tmp");
  CommandResult result = folder.render("write@a.pfm");
  CAPTURE(result.err);
  CHECK(result.status == 1);
  CHECK(is_one_error_line(result.err));
  CHECK(contains(result.err, "No space left on device; the image is in " + folder.file("tmp") + "/"));
  for (const auto& file : std::filesystem::directory_iterator(folder / "tmp"))
    CHECK(read_file(file.path()) == plain);
  CHECK_FALSE(std::filesystem::is_empty(folder / "tmp"));
  result = folder.render("write@a.pfm", {"--resume", folder.file("c")});
  CHECK(result.status == 1);
  CHECK(contains(result.err, "all of it is in " + folder.file("c")));
  std::filesystem::remove(folder / "a.pfm");
  CHECK(folder.render("launch=-5@0:0,launch=-5@0:1", {"--resume", folder.file("c")}).status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);  // without a launch
}

TEST_CASE("a kernel cache that is corrupt or cannot be written costs time only") {
  FaultyFolder folder;
  const std::string plain = folder.plain();
  folder.options.environment["XDG_CACHE_HOME"] = folder.file("cache");
  folder.options.environment["POCL_CACHE_DIR"] = folder.file("pocl");
  const std::vector<std::string> one = {"--device", "!0:0"};
  SECTION("corrupt") {
    REQUIRE(folder.render("", one).status == 0);
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "cache/sundog"))
      if (file.is_regular_file()) std::ofstream(file.path(), std::ios::in | std::ios::out).seekp(300) << "xx";
    REQUIRE(folder.render("", one).status == 0);
    CHECK(folder.stats()["kernels_cached"] == false);
    CHECK(read_file(folder / "a.pfm") == plain);
    REQUIRE(folder.render("", one).status == 0);
    CHECK(folder.stats()["kernels_cached"] == true);
  }
  SECTION("PoCL's own, at which it would abort") {
    folder.options.environment["POCL_CACHE_DIR"] = "";
    // What a process that was killed has left, in the folder that PoCL takes by itself and in sundog's.
    for (const char* place : {"cache/pocl/kcache", "cache/sundog/pocl/killed"}) {
      CommandOptions user = folder.options;
      user.environment["POCL_CACHE_DIR"] = folder.file(place);
      std::filesystem::create_directories(folder / place);
      REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("b.pfm")}, user).status == 0);
      int files = 0;
      for (const auto& file : std::filesystem::recursive_directory_iterator(folder / place))
        if (file.path().extension() == ".bc" || file.path().extension() == ".so")
          std::ofstream(file.path(), std::ios::in | std::ios::out).seekp(20) << "xxxxxxxxxxxx", ++files;
      REQUIRE(files > 0);
    }
    folder.write("cache/sundog/pocl/killed/lock", "");
    for (const char* kernels : {"", "off"}) {
      folder.options.environment["SUNDOG_KERNEL_CACHE"] = kernels;
      CHECK(folder.render("", one).status == 0);
      CHECK(read_file(folder / "a.pfm") == plain);
    }
    CHECK(std::filesystem::is_empty(folder / "cache/sundog/pocl"));
  }
  SECTION("a file where the folder should be") {
    folder.write("cache", "");
    const CommandResult result = folder.render("", one);
    CHECK(result.status == 0);
    CHECK(result.err.empty());
    CHECK(contains(folder.stats()["devices"][0]["notes"].at(0), "no kernel cache: "));
  }
  SECTION("a file where the folder should be that PoCL has no device without") {
    folder.write("cache", "");
    std::filesystem::create_directories(folder / "temporary");
    folder.options.environment["POCL_CACHE_DIR"] = "";
    folder.options.environment["TMPDIR"] = folder.file("temporary");
    CHECK(folder.render("", one).status == 0);
    CHECK(std::filesystem::is_empty(folder / "temporary"));
  }
  CHECK(read_file(folder / "a.pfm") == plain);
}

TEST_CASE("faults that nobody understands are refused") {
  FaultyFolder folder;
  const CommandResult result = folder.render("build");
  CHECK(result.status == 2);
  CHECK(contains(result.err, "SUNDOG_FAULTS: wanted KIND"));
}

TEST_CASE(
    "a process that compiles beside the renderer, and one that fails at it, make no difference to the "
    "picture") {
  const CliFolder folder;
  CommandOptions options;
  std::vector<std::string> pictures;
  for (const std::string faults : {"", "compile@0:0"}) {
    options.environment["SUNDOG_FAULTS"] = faults;
    options.environment["XDG_CACHE_HOME"] = folder.file("cache" + faults);  // nothing is compiled yet
    const CommandResult result =
        run_sundog({"render", folder.scene, "-o", folder.file("a.pfm"), "--device", "0:0"}, options);
    CAPTURE(faults, result.err);
    REQUIRE(result.status == 0);
    CHECK(result.err.empty());
    pictures.push_back(read_file(folder / "a.pfm"));
  }
  CHECK(pictures[0] == pictures[1]);
}
