// Lists this process's devices, and selects those that a command's options name.
#pragma once
#include <string>
#include <vector>

#include "device/devices.h"

namespace sundog {

/// All devices that this process sees.
std::vector<DeviceInfo> list_devices();

/// The SPECs in SUNDOG_DEVICE, which commas separate.
std::vector<std::string> devices_of_environment();

/// The devices of `all` that `specs` select (select_devices()), or SUNDOG_DEVICE if `specs` is empty. Prints
/// warnings to stderr. If neither is given and `verbose`, prints the default device and the reason to stdout.
/// Throws DeviceError, UsageError.
std::vector<DeviceInfo> pick_devices(const std::vector<DeviceInfo>& all, std::vector<std::string> specs,
                                     bool verbose = false);
/// pick_devices() from the devices of this process.
std::vector<DeviceInfo> pick_devices(const std::vector<std::string>& specs, bool verbose = false);

}  // namespace sundog
