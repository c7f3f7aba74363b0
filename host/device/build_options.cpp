// See build_options.h.
#include "device/build_options.h"

#include <cstdlib>

#include "base/environment.h"

namespace sundog {
namespace {

// Always requests argument information, so that tests check the program that renders.
constexpr const char* own_options = "-cl-std=CL1.2 -cl-kernel-arg-info";

}  // namespace

std::string all_build_options(const HostEnvironment& environment, const BuildWish& wish) {
  std::string options = own_options;
  for (const std::string& more : {environment.build_options, wish.options})
    if (!more.empty()) options += " " + more;
  return options;
}

void bypass_driver_caches() {
  setenv("CUDA_CACHE_DISABLE", "1", 0);  // NVIDIA's
}

}  // namespace sundog
