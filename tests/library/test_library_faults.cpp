// Programs see drivers fail: faults on demand, in a program of its own (tests/faulty_program).
#include <algorithm>

#include "library_testing.h"
#include "run_command.h"
#include "temporary_folder.h"

using sundog::ErrorKind;

namespace {

/// The program's output for a device with that fault, such as "launch=-36" or "build" with the count "#2".
std::string seen_of(const std::string& what, const std::string& fault, const std::string& count = "") {
  const TemporaryFolder folder;
  folder.write("scene.json", small_scene().to_json());
  const std::string label = test_device().at(0).label, place = label.substr(0, label.find_first_of(" @"));
  CommandOptions options;
  options.environment["SUNDOG_FAULTS"] = fault + "@" + place + count;
  const CommandResult tried =
      run_command({SUNDOG_FAULTY_PROGRAM, what, test_spec(), (folder / "scene.json").string()}, options);
  CAPTURE(tried.out, tried.err);
  CHECK(tried.status == 0);
  return tried.out;
}

std::string kind(ErrorKind kind) { return "kind " + std::to_string(static_cast<int>(kind)); }

}  // namespace

TEST_CASE("a device whose launches fail is an error with OpenCL's code") {
  const std::string seen = seen_of("launch", "launch=-36");
  CAPTURE(seen);
  CHECK(seen.find("render: " + kind(ErrorKind::device) + ", status -36\n") != std::string::npos);
  CHECK(seen.find("finish: " + kind(ErrorKind::device)) != std::string::npos);
  const std::string snapshot = seen.substr(std::min(seen.size(), seen.find("snapshot: ")));
  CHECK(snapshot.find(test_device()[0].label) != std::string::npos);
}

TEST_CASE("a kernel for picks that does not build is an error, and the picture stays") {
  (void)sundog::render(small_scene(),
                       {.devices = test_device()});  // is cached: the second build is the pick's
  const std::string seen = seen_of("pick", "build", "#2");
  CAPTURE(seen);
  CHECK(seen.find("pick: " + kind(ErrorKind::build)) != std::string::npos);
  CHECK(seen.find("picture: 64\n") != std::string::npos);
}
