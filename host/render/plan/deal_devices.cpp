// Deals each device to the rank with the fewest, and divides a CPU among its ranks.
#include "render/plan/deal_devices.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace sundog {
namespace {

struct Candidate {
  const DeviceInfo* device;
  unsigned cores;
};

/// Equal for the same device of a machine.
using Place = std::tuple<std::string, std::string, int, int, std::string>;

Place place(const DeviceInfo& device) {
  const bool known = !device.identity.empty() && device.type != "cpu";
  if (known) return {device.host, device.identity, 0, 0, ""};
  return {device.host, "", device.platform, device.device, device.name};
}

/// A sub-device of `units`, or the whole device if it has no more.
DeviceInfo part(DeviceInfo device, unsigned units) {
  if (units >= device.compute_units) return device;
  device.estimate *= static_cast<double>(units) / device.compute_units;
  device.sub_units = units;
  return device;
}

/// Divides one CPU among the ranks that see it.
void divide(const std::vector<Candidate>& candidates, std::vector<DeviceInfo>& dealt) {
  const DeviceInfo& whole = *candidates.front().device;
  const auto ranks = static_cast<unsigned>(candidates.size());
  for (unsigned i = 0; i < ranks; ++i) {
    const Candidate& candidate = candidates[i];
    unsigned units = whole.compute_units / ranks + (i < whole.compute_units % ranks);
    if (candidate.cores > 0) units = std::min(units, candidate.cores);
    if (units > 0) dealt.push_back(part(*candidate.device, units));
  }
}

}  // namespace

std::vector<DeviceInfo> deal_devices(const std::vector<RankDevices>& ranks) {
  std::vector<DeviceInfo> dealt;
  std::map<Place, std::vector<Candidate>> places;
  std::vector<Place> in_order;
  for (const RankDevices& rank : ranks)
    for (const DeviceInfo& device : rank.devices) {
      if (device.sub_units > 0) {
        dealt.push_back(device);
        continue;
      }
      std::vector<Candidate>& candidates = places[place(device)];
      if (candidates.empty()) in_order.push_back(place(device));
      candidates.push_back({&device, rank.cores});
    }
  std::map<int, int> counts;  // devices per rank
  for (const Place& each : in_order) {
    const std::vector<Candidate>& candidates = places[each];
    if (candidates.front().device->type == "cpu" && candidates.front().device->max_sub_devices > 1) {
      divide(candidates, dealt);
      continue;
    }
    const auto least = std::ranges::min_element(
        candidates, {}, [&](const Candidate& candidate) { return counts[candidate.device->rank]; });
    ++counts[least->device->rank];
    dealt.push_back(*least->device);
  }
  std::ranges::stable_sort(dealt, {}, &DeviceInfo::rank);
  return dealt;
}

}  // namespace sundog
