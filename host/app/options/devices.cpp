// Lists devices, reads SUNDOG_DEVICE, and prints the warnings of a selection.
#include "app/options/devices.h"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "app/process/environment.h"
#include "app/process/warnings.h"
#include "device/choice.h"

namespace sundog {

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> devices = enumerate_devices(program_environment());
  for (DeviceInfo& device : devices) device.threads = driver_threads();
  return devices;
}

std::vector<std::string> devices_of_environment() {
  const char* text = std::getenv("SUNDOG_DEVICE");
  if (!text || !*text) return {};
  std::vector<std::string> specs;
  std::istringstream all(text);
  for (std::string spec; std::getline(all, spec, ',');) {
    const std::size_t first = spec.find_first_not_of(" \t\n\v\f\r");
    specs.push_back(
        first == spec.npos ? "" : spec.substr(first, spec.find_last_not_of(" \t\n\v\f\r") - first + 1));
  }
  return specs;
}

std::vector<DeviceInfo> pick_devices(const std::vector<DeviceInfo>& all, std::vector<std::string> specs,
                                     bool verbose) {
  if (specs.empty()) specs = devices_of_environment();
  std::vector<std::string> warnings;
  const std::vector<DeviceInfo> chosen = select_devices(all, specs, &warnings);
  print_warnings(warnings);
  if (specs.empty() && verbose) fmt::print("default device: {}\n", choice_text(all, chosen.front()));
  return chosen;
}

std::vector<DeviceInfo> pick_devices(const std::vector<std::string>& specs, bool verbose) {
  return pick_devices(list_devices(), specs, verbose);
}

}  // namespace sundog
