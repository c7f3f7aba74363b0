// Devices and their combinations on one scene, best first, with the share of the picture that each made.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "render/render.h"

namespace sundog {

/// Each device alone, each pair, and all together. Pure.
std::vector<std::vector<DeviceInfo>> device_combinations(const std::vector<DeviceInfo>& devices);

struct DeviceTime {
  std::vector<DeviceInfo> devices;
  Spread seconds;               // a frame, without building kernels
  double efficiency = 0;        // work done over what the devices could have done
  std::vector<double> shares;   // of the pixels, in the devices' order
  std::uint64_t differing = 0;  // pixels visibly unlike those of the first device
  std::string problem;          // not empty: no time counts, and why
};

/// Renders once with each combination to warm up, then `repeat` times in turn. A picture that is not the
/// first device's but for rounding is a problem, and so is a device that took no part. `on_step` hears what
/// is measured.
std::vector<DeviceTime> measure_devices(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                                        int repeat, const std::function<void(const std::string&)>& on_step);

/// Adds the ranking, bars and measurements.
void add_device_tables(Report& report, const std::string& scene, std::vector<DeviceTime> times, int repeat);

}  // namespace sundog
