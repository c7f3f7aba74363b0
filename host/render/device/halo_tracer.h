// Halos traced by a device: the map of trace_halo() (compile/halo/halo_map.h), to the bit.
#pragma once
#include <functional>

#include "compile/halo/halo_map.h"
#include "device/device.h"

namespace sundog {

/// The local sizes and the number of lanes are for tests: no map depends on them. 0: the device's own.
struct HaloLaunchSizes {
  unsigned lanes = 0, local = 0;
};

/// Compiles what trace_halo_on() uses, or takes it from the cache. Throws DeviceError, BuildError.
void build_halo_kernel(Device& device);

/// `progress` has the rays done, and returns false to give up (then the map is empty). Throws DeviceError,
/// BuildError.
HaloMap trace_halo_on(Device& device, const HaloPlan& plan,
                      const std::function<bool(std::uint64_t)>& progress = {},
                      const HaloLaunchSizes& sizes = {});

}  // namespace sundog
