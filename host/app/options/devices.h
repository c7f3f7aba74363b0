// The devices of this process, and those that a command's options choose.
#pragma once
#include <string>
#include <vector>

#include "device/devices.h"

namespace sundog {

/// The devices of this process.
std::vector<DeviceInfo> list_devices();

/// SPECs of SUNDOG_DEVICE, separated by commas.
std::vector<std::string> devices_of_environment();

/// The devices of `all` that `specs` mean (select_devices); without any, those of SUNDOG_DEVICE. Warns on
/// stderr of exclusions that match nothing; with `verbose`, says on stdout which device is the default and
/// why, where there are no specs. Throws DeviceError, UsageError.
std::vector<DeviceInfo> pick_devices(const std::vector<DeviceInfo>& all, std::vector<std::string> specs,
                                     bool verbose = false);
/// Of those of this process.
std::vector<DeviceInfo> pick_devices(const std::vector<std::string>& specs, bool verbose = false);

}  // namespace sundog
