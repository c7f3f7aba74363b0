// Which rank of a job serves which device: every device of a machine once, however many ranks run there.
#pragma once
#include <string>
#include <vector>

#include "device/devices.h"

namespace sundog {

/// The devices that were chosen among those one rank sees, their `rank` and `host` filled in.
struct RankDevices {
  unsigned cores = 0;  // that the rank may run on; 0: unknown
  std::vector<DeviceInfo> devices;
};

/// A device that several ranks of a machine see goes to the one of them that has least so far. A processor is
/// divided among them instead: each gets a sub-device of its share of the compute units, of not more than the
/// cores it may run on. Ranks for which nothing is left get nothing. Sub-devices that were asked for by size
/// are everybody's own. In order of rank.
std::vector<DeviceInfo> deal_devices(const std::vector<RankDevices>& ranks);

}  // namespace sundog
