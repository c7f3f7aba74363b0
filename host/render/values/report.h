// What a frame counts, measures and reports, device by device.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "device/devices.h"
#include "device/launches.h"
#include "shared/scene.h"

namespace sundog {

/// Sums over the frame, in the order of the COUNT_* constants.
using RayCounts = std::array<std::uint64_t, COUNTERS>;

struct DeviceReport {
  DeviceInfo info;
  std::uint64_t tiles = 0, failures = 0;
  std::uint64_t pixels = 0;           // in the image from it
  std::uint64_t outrun = 0;           // tiles that another device finished sooner
  double busy_seconds = 0;            // on tiles that it finished
  double share = 0;                   // of the frame's pixels
  bool ready = false;                 // its kernels were built before the frame's end
  bool retired = false;               // it failed too often, or hangs
  bool abandoned = false;             // its driver still had not come back at the end
  std::vector<std::string> messages;  // its failures
  std::vector<std::string> notes;     // what it could live with
  std::map<std::string, KernelTimes> kernels;
  bool kernels_cached = false;
  std::uint64_t tables_uploaded = 0, bytes_uploaded = 0;
  std::uint64_t kernels_built = 0;  // programs, by the driver's compiler
};

/// Wall seconds on the frame's clock; what overlaps is charged once. build_kernels holds what drivers spend
/// on a kernel before its first launch runs.
struct RenderTimes {
  double build_kernels = 0, upload = 0, render = 0, readback = 0;
  bool cached = false;  // every program came from the cache
};

}  // namespace sundog
