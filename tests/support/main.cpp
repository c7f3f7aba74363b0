// The tests' main(): Catch2's own, after a word on the optional assets.
#ifndef SUNDOG_CATCH2_V3
#define CATCH_CONFIG_RUNNER
#endif
#include "catch.h"

#include <cstdio>

#include "assets.h"
#include "devices.h"

int main(int argc, char** argv) {
  prepare_opencl_environment();
  if (const auto assets = assets_directory(); assets.empty())
    std::printf("no test assets (SUNDOG_ASSETS or ../shared/assets): the tests of real models did without\n");
  return Catch::Session().run(argc, argv);
}
