// Traces a halo's map on a device, before its scene is compiled.
#pragma once
#include <string>
#include <vector>

#include "compile/halo/halo_map.h"
#include "device/devices.h"

namespace sundog {

struct TracedHalo {
  HaloMap map;
  std::uint64_t rays = 0;
  double seconds = 0;  // time to trace, without compiling the kernel
  std::string device;  // the device's label, or "host"
};

/// Traces on the first of `devices` that works, else on the host; the map is the same. Draws a progress bar
/// unless `quiet`; warns about devices that fail.
TracedHalo trace_halo_map(const EnvironmentDescription& environment, const std::vector<DeviceInfo>& devices,
                          bool quiet);

}  // namespace sundog
