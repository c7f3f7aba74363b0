// Measures the joules that devices use, if the machine has counters for them.
#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "device/devices.h"

namespace sundog {

/// Reads processors' energy from RAPL (powercap) or a hwmon driver, NVIDIA GPUs' from NVML, which is loaded
/// at run time if present.
class EnergyMeter {
 public:
  /// Measures each GPU, and all processors together if a device is one. `system`: "/sys", or a copy of its
  /// files.
  explicit EnergyMeter(std::span<const DeviceInfo> devices, const std::string& system = "/sys");

  /// Joules since construction; below 0 if a device has no counter.
  double joules();
  /// The first GPU's clock in MHz; 0: unknown.
  double clock() const { return clock_ ? clock_() : 0; }
  /// "RAPL, package-0, package-1": the counters, or why there are none.
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

/// "energy" of `render --stats`: `joules` (below 0: unknown), `watts`, and what they are `counted_by`.
nlohmann::json energy_json(double joules, double seconds, const std::string& source);

}  // namespace sundog
