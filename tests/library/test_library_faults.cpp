// What programs see of drivers that fail: by faults on demand, which the library reads once a process, so
// that each is tried in one of its own.
#include "library_testing.h"
#include "run_command.h"

namespace fs = std::filesystem;
using sundog::ErrorKind;

namespace {

/// Runs a hidden test of this program with a fault on the tests' device.
void try_with(const std::string& fault, const std::string& hidden_test) {
  const std::string label = test_device().at(0).label, place = label.substr(0, label.find(' '));
  CommandOptions options;
  options.environment["SUNDOG_FAULTS"] = fault + "@" + place.substr(0, place.find('@'));
  if (fault.find('#') != std::string::npos)
    options.environment["SUNDOG_FAULTS"] =
        fault.substr(0, fault.find('#')) + "@" + place + fault.substr(fault.find('#'));
  const CommandResult tried =
      run_command({fs::read_symlink("/proc/self/exe").string(), hidden_test}, options);
  CAPTURE(tried.out, tried.err);
  CHECK(tried.status == 0);
  CHECK(tried.out.find("All tests passed") != std::string::npos);
}

}  // namespace

TEST_CASE("a device whose launches fail is an error with OpenCL's code", "[.][launches-fail]") {
  const sundog::Error error =
      error_of([] { (void)sundog::render(small_scene(), {.devices = test_device()}); });
  CHECK(error.kind() == ErrorKind::device);
  CHECK(error.status() == -36);
  sundog::Session session(test_device());
  session.start(small_scene());
  CHECK(error_of([&] { (void)session.finish(); }).kind() == ErrorKind::device);
  CAPTURE(session.snapshot().error);
  CHECK(session.snapshot().error.find(test_device()[0].label) != std::string::npos);
}

TEST_CASE("a kernel for picks that does not build is an error, and the picture stays",
          "[.][second-build-fails]") {
  sundog::Session session(test_device());
  session.start(small_scene());
  session.wait();
  CHECK(error_of([&] { (void)session.pick(1, 1); }).kind() == ErrorKind::build);
  CHECK(session.finish().width() == 64);
}

TEST_CASE("drivers that fail are errors of their kind") {
  try_with("launch=-36", "[launches-fail]");
  try_with("build#2", "[second-build-fails]");
}
