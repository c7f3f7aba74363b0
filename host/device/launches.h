// Launch sizes and times, as plain values.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sundog {

/// Global and local size of a launch. The global size is padded to whole work-groups, so kernels check their
/// index against the count passed to them. local = {0, 0}: the driver chooses.
struct LaunchSize {
  std::size_t x = 1, y = 1;
  std::size_t local_x = 64, local_y = 1;
};

/// A launch of one work-group without work, which makes some drivers generate a kernel's machine code in
/// advance. All arguments are zero and buffers hold a few pages of zeros, which the kernel must treat as no
/// work.
struct EmptyLaunch {
  std::string kernel;
  std::size_t local_x = 1, local_y = 1;
  std::vector<std::size_t> argument_bytes;  // 0: a buffer
};

/// Totals of one kernel's launches on one device. device_ms is from events, 0 if the driver has none. host_ms
/// is by the host's clock, from the first enqueue of a batch to the end of finish(), divided among the
/// batch's launches by event time (equally without events). first_ms is the part of host_ms beyond event time
/// for first launches of a local size, when drivers compile or load the kernel. local_x and local_y are from
/// the last launch; 0: chosen by the driver.
struct KernelTimes {
  std::uint64_t launches = 0;
  double device_ms = 0, host_ms = 0, first_ms = 0;
  std::size_t local_x = 0, local_y = 0;
};

/// Seconds that a driver spent before first launches, over all kernels.
inline double first_launch_seconds(const std::map<std::string, KernelTimes>& kernels) {
  double milliseconds = 0;
  for (const auto& [name, times] : kernels) milliseconds += times.first_ms;
  return 1e-3 * milliseconds;
}

}  // namespace sundog
