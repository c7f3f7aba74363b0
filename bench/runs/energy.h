// Joules that devices have used, where something here counts them.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "device/devices.h"

namespace sundog {

/// Processors by RAPL (powercap) or a hwmon driver's energy counters, NVIDIA's GPUs by NVML, which is loaded
/// when it is there.
class EnergyMeter {
 public:
  /// Measures each GPU, and all processors together if a device is one. `system`: "/sys", or a copy of its
  /// files.
  explicit EnergyMeter(std::span<const DeviceInfo> devices, const std::string& system = "/sys");

  /// Since it was made; below 0: nothing counts them for one of the devices.
  double joules();
  /// MHz at which the first GPU runs; 0: not known.
  double clock() const { return clock_ ? clock_() : 0; }
  /// "RAPL, package-0, package-1": what counts; or why nothing does.
  const std::string& source() const { return source_; }

 private:
  struct Counter {
    std::string name;
    std::function<double()> joules;  // below 0: it could not be read
    double wraps_at = 0;             // joules; 0: it does not wrap
    double last = 0, sum = 0;
  };
  std::string add_processors(const std::string& system);
  std::string add_gpu(const DeviceInfo& device);

  std::vector<Counter> counters_;
  std::function<double()> clock_;
  std::string source_;
};

}  // namespace sundog
