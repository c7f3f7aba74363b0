// The tests' main(): prepares the drivers, reports missing assets, and runs Catch2.
#ifndef SUNDOG_CATCH2_V3
#define CATCH_CONFIG_RUNNER
#endif
#include "catch.h"

#include <cstdio>
#include <filesystem>
#include <string>

#include "assets.h"
#include "devices.h"
#include "scenes.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace {

#ifdef SUNDOG_CATCH2_V3
using ListenerBase = Catch::EventListenerBase;
#else
using ListenerBase = Catch::TestEventListenerBase;
#endif

/// Resets calls_on_devices() at each run of a test case, which Catch2 reports as an outermost section.
struct CountCallsAnew : ListenerBase {
  using ListenerBase::ListenerBase;
  void testCaseStarting(const Catch::TestCaseInfo& info) override {
    ListenerBase::testCaseStarting(info);
    open_ = 0;
  }
  void sectionStarting(const Catch::SectionInfo& info) override {
    ListenerBase::sectionStarting(info);
    if (open_++ == 0) calls_on_devices() = 0;
  }
  void sectionEnded(const Catch::SectionStats& stats) override {
    ListenerBase::sectionEnded(stats);
    --open_;
  }

 private:
  int open_ = 0;
};
CATCH_REGISTER_LISTENER(CountCallsAnew)

}  // namespace

int main(int argc, char** argv) {
  // With llvmpipe, each process that lists devices takes a fifth of a second longer. Only these two programs
  // use it; the tests of the command line start a thousand processes, which do not.
  const std::string program = std::filesystem::path(argv[0]).filename();
  prepare_opencl_environment(program == "device_tests" || program == "library_tests");
  if (const auto assets = assets_directory(); assets.empty())
    std::printf("no test assets (SUNDOG_ASSETS or ../shared/assets): the tests of real models did without\n");
  const int status = Catch::Session().run(argc, argv);
  scenes::close_sessions();
#ifdef __SANITIZE_ADDRESS__
  // Checks before the process ends: drivers keep some memory until then (PoCL a compiler for each device),
  // and at exit free only the table that refers to it.
  __lsan_do_leak_check();
#endif
  return status;
}
