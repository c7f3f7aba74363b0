// Traces halos on a device; the map equals trace_halo()'s (compile/halo/halo_map.h) bit for bit.
#pragma once
#include <functional>

#include "compile/halo/halo_map.h"
#include "device/device.h"
#include "render/device/scene_programs.h"

namespace sundog {

/// Local sizes and number of lanes, for tests; maps do not depend on them. 0: the device's default.
struct HaloLaunchSizes {
  unsigned lanes = 0, local = 0;
};

SceneProgram halo_program(const DeviceInfo& device);

/// Builds the kernel of trace_halo_on(), or loads it from the cache. Throws DeviceError, BuildError.
void build_halo_kernel(Device& device);

/// `progress` receives the number of rays done and returns false to cancel (the map is then empty). Throws
/// DeviceError, BuildError.
HaloMap trace_halo_on(Device& device, const HaloPlan& plan,
                      const std::function<bool(std::uint64_t)>& progress = {},
                      const HaloLaunchSizes& sizes = {});

}  // namespace sundog
