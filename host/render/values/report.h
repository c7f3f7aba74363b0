// Statistics of a frame and of each device.
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

/// Totals of the frame, in the order of the COUNT_* constants.
using RayCounts = std::array<std::uint64_t, COUNTERS>;

/// A worker's statistics so far.
struct WorkerFigures {
  std::map<std::string, KernelTimes> kernels;
  double readback_seconds = 0;
  std::vector<std::string> notes;  // problems that did not stop it: smaller launches, an unusable cache
  std::uint64_t tables_uploaded = 0, bytes_uploaded = 0;
  std::uint64_t kernels_built = 0;  // programs compiled by the driver
};

struct DeviceReport : WorkerFigures {
  DeviceInfo info;
  std::uint64_t tiles = 0, failures = 0;
  std::uint64_t pixels = 0;                // kept in the image
  std::uint64_t outrun = 0;                // tiles that another device finished sooner
  double busy_seconds = 0;                 // rendering tiles that it finished
  double share = 0;                        // share of the frame's pixels
  bool ready = false;                      // its kernels were built before the end of the frame
  bool retired = false;                    // it failed too often, or hangs
  bool abandoned = false;                  // its driver had not returned at the end
  std::vector<std::string> messages = {};  // its failures
  bool kernels_cached = false;
};

/// Wall-clock seconds of the frame; overlapping work is counted once. build_kernels includes drivers'
/// preparation of first launches.
struct RenderTimes {
  double build_kernels = 0, upload = 0, render = 0, readback = 0;
  bool cached = false;  // every program came from the cache
};

}  // namespace sundog
