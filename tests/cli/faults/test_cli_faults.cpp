// Faults of devices, drivers and disks cost time, not the frame. SUNDOG_FAULTS asks for them (base/faults.h).
#include <base/file.h>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "faulty_folder.h"

using namespace sundog;
using nlohmann::json;

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
  CHECK(contains(result.err, note));
  const json device = folder.stats()["devices"][0];
  CHECK(device["failures"] == 0);
  CHECK(device["retired"] == false);
}

// With the compact tracer, whose groups are of 8 work-items at least however many units there are.
TEST_CASE("a kernel's own limit bounds its work-groups, and a larger one is refused by name") {
  FaultyFolder folder;
  std::vector<std::string> one = {"--device", "!0:0", "--set", "/render/tracer=compact"};
  const auto group = [&] {
    const json sides = folder.stats()["devices"][0]["kernels"]["render_whitted"]["work_group"];
    return sides.at(0).get<int>() * sides.at(1).get<int>();
  };
  REQUIRE(folder.render("", one).status == 0);
  REQUIRE(group() >= 8);
  const std::string plain = read_file(folder / "a.pfm");
  // A group of more would be noticed in each launch, and told in a note.
  CommandResult result = folder.render("limit=2@0:1,group=-54>2@0:1", one);
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);
  CHECK(group() == 2);
  CHECK_FALSE(contains(folder.stats()["devices"][0]["notes"].dump(), "work-groups of at most"));
  one.insert(one.end(), {"--work-group", "4"});
  result = folder.render("limit=2@0:1", one);
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
  CHECK(contains(result.err, "launches of at most"));
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

TEST_CASE("when every device fails the finished part is saved, and a checkpoint continues from it") {
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
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "tmp"))
    if (file.is_regular_file()) CHECK(read_file(file.path()) == plain);
  CHECK_FALSE(std::filesystem::is_empty(folder / "tmp"));
  result = folder.render("write@a.pfm", {"--resume", folder.file("c")});
  CHECK(result.status == 1);
  CHECK(contains(result.err, "all of it is in " + folder.file("c")));
  std::filesystem::remove(folder / "a.pfm");
  CHECK(folder.render("launch=-5@0:0,launch=-5@0:1", {"--resume", folder.file("c")}).status == 0);
  CHECK(read_file(folder / "a.pfm") == plain);  // without a launch
}

TEST_CASE("faults that nobody understands are refused") {
  FaultyFolder folder;
  const CommandResult result = folder.render("build");
  CHECK(result.status == 2);
  CHECK(contains(result.err, "SUNDOG_FAULTS: wanted KIND"));
}

TEST_CASE("variables of seconds that are no numbers above 0 are refused by name") {
  for (const char* name : {"SUNDOG_LAUNCH_LIMIT", "SUNDOG_SILENCE_LIMIT"})
    for (const char* value : {"x", "2s", "0", "-1", "inf", "nan"}) {
      FaultyFolder folder;
      folder.options.environment[name] = value;
      const CommandResult result = folder.render("");
      CHECK(result.status == 2);
      CHECK(contains(result.err, std::string("sundog: ") + name + "=" + value + ": wanted seconds above 0"));
    }
}
