// The tests' main(): Catch2's own, after a word on the optional assets.
#ifndef SUNDOG_CATCH2_V3
#define CATCH_CONFIG_RUNNER
#endif
#include "catch.h"

#include <cstdio>

#include "assets.h"
#include "devices.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

int main(int argc, char** argv) {
  prepare_opencl_environment();
  if (const auto assets = assets_directory(); assets.empty())
    std::printf("no test assets (SUNDOG_ASSETS or ../shared/assets): the tests of real models did without\n");
  const int status = Catch::Session().run(argc, argv);
#ifdef __SANITIZE_ADDRESS__
  // Before the end of the process: drivers keep some memory as long as it lives (PoCL a compiler for each
  // device) and only free the table that leads to it.
  __lsan_do_leak_check();
#endif
  return status;
}
