// Open devices that wait between frames, with what they have built: one set-up for a whole animation.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "device/device.h"

namespace sundog {

class DevicePool {
 public:
  /// The one that waits for this index and number of units, or a newly opened one. Any thread. Throws
  /// DeviceError.
  std::unique_ptr<Device> take(const DeviceInfo& info);
  /// Keeps a device that works; its times start anew.
  void give_back(std::unique_ptr<Device> device);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Device>> waiting_;
};

}  // namespace sundog
