// See pick_devices.h.
#include "app/options/pick_devices.h"

#include <fmt/format.h>

#include "app/process/warnings.h"
#include "device/choice.h"

namespace sundog {

std::vector<DeviceInfo> pick_devices(const std::vector<DeviceInfo>& all,
                                     const std::vector<std::string>& specs, bool verbose) {
  std::vector<std::string> warnings;
  const std::vector<DeviceInfo> chosen = select_devices(all, specs, &warnings);
  print_warnings(warnings);
  if (specs.empty() && verbose) fmt::print("default device: {}\n", choice_text(all, chosen.front()));
  return chosen;
}

}  // namespace sundog
