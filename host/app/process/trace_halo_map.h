// A halo's map is traced by a device before its scene is compiled.
#pragma once
#include <string>
#include <vector>

#include "compile/halo/halo_map.h"
#include "device/devices.h"

namespace sundog {

struct TracedHalo {
  HaloMap map;
  std::uint64_t rays = 0;
  double seconds = 0;  // of tracing, the kernel's compilation apart
  std::string device;  // its label
};

/// By the first of `devices` that can, else by the host: the map is the same. With a progress bar on stderr
/// where that is a terminal; warns of devices that fail.
TracedHalo trace_halo_map(const EnvironmentDescription& environment, const std::vector<DeviceInfo>& devices,
                          bool quiet);

}  // namespace sundog
