// See build_options.h.
#include "device/build_options.h"

#include <cstdlib>
#include <sstream>

#include "base/environment.h"
#include "device/device_rules.h"

namespace sundog {
namespace {

// Always requests argument information, so that tests check the program that renders.
constexpr const char* own_options = "-cl-std=CL1.2 -cl-kernel-arg-info";

/// An option up to its value.
std::string name_of(const std::string& option) { return option.substr(0, option.find('=')); }

}  // namespace

std::string all_build_options(const DeviceInfo& device, const BuildWish& wish) {
  const HostEnvironment& environment = value_of(device.environment);
  std::string options = own_options;
  std::istringstream of_device{std::string(rule_of(device).options)};
  for (std::string option; of_device >> option;)
    if (environment.build_options.find(name_of(option)) == std::string::npos) options += " " + option;
  for (const std::string& more : {environment.build_options, wish.options})
    if (!more.empty()) options += " " + more;
  return options;
}

void bypass_driver_caches() {
  setenv("CUDA_CACHE_DISABLE", "1", 0);  // NVIDIA's
}

}  // namespace sundog
