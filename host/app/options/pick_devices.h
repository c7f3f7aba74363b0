// The devices of a command, with what a person should hear about the choice.
#pragma once
#include <string>
#include <vector>

#include "device/devices.h"

namespace sundog {

/// The devices of `all` that `specs` mean (select_devices). Warns on stderr of exclusions that match nothing;
/// with `verbose`, says on stdout which device is the default and why, where there are no specs. Throws
/// DeviceError, UsageError.
std::vector<DeviceInfo> pick_devices(const std::vector<DeviceInfo>& all,
                                     const std::vector<std::string>& specs, bool verbose = false);

}  // namespace sundog
