// What this program hands down to the layers below (base/environment.h), with its own way to start itself.
#pragma once
#include <vector>

#include "base/environment.h"
#include "device/devices.h"
#include "scene/load.h"

namespace sundog {

/// Read at the first call, which a command makes before it has threads. Throws UsageError for SUNDOG_FAULTS
/// that are none.
const EnvironmentPtr& program_environment();

/// The devices of this process.
std::vector<DeviceInfo> list_devices();

/// The options, with the standard input for a scene named "-".
LoadOptions with_streams(LoadOptions options);

}  // namespace sundog
