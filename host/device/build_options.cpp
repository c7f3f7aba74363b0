// See build_options.h.
#include "device/build_options.h"

#include <cstdlib>

namespace sundog {
namespace {

// Argument information is asked for always, so that the tests check the very program that renders.
constexpr const char* own_options = "-cl-std=CL1.2 -cl-kernel-arg-info";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

std::string user_build_options() { return variable("SUNDOG_BUILD_OPTIONS"); }

std::string all_build_options(const BuildWish& wish) {
  std::string options = own_options;
  for (const std::string& more : {user_build_options(), wish.options})
    if (!more.empty()) options += " " + more;
  return options;
}

std::string build_log_folder() { return variable("SUNDOG_BUILD_LOG"); }

void bypass_driver_caches() {
  setenv("CUDA_CACHE_DISABLE", "1", 0);  // NVIDIA's
}

}  // namespace sundog
