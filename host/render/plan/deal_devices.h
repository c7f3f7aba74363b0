// Assigns devices to the ranks of a job: every device of a machine once, however many ranks run there.
#pragma once
#include <vector>

#include "device/devices.h"

namespace sundog {

/// The devices selected among those one rank sees, with `rank` and `host` set.
struct RankDevices {
  unsigned cores = 0;  // cores on which the rank may run; 0: unknown
  std::vector<DeviceInfo> devices;
};

/// A device that several ranks of a machine see goes to the rank with the fewest devices so far. A CPU is
/// divided instead: each rank gets a sub-device with its share of the compute units, but at most as many as
/// the cores on which it may run. Some ranks may get nothing. Sub-devices requested by size belong to each
/// rank. Returns the devices in order of rank.
std::vector<DeviceInfo> deal_devices(const std::vector<RankDevices>& ranks);

}  // namespace sundog
