#include "device/device_pool.h"

#include <algorithm>

namespace sundog {

std::unique_ptr<Device> DevicePool::take(const DeviceInfo& info) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(waiting_, [&](const auto& device) {
      const DeviceInfo& other = device->info();
      return other.platform == info.platform && other.device == info.device &&
             other.sub_units == info.sub_units && other.first_unit == info.first_unit;
    });
    if (found != waiting_.end()) {
      std::unique_ptr<Device> device = std::move(*found);
      waiting_.erase(found);
      return device;
    }
  }
  return std::make_unique<Device>(info);
}

void DevicePool::give_back(std::unique_ptr<Device> device) {
  device->forget_times();
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(device));
}

}  // namespace sundog
