// What a launch is enqueued with, and what launches took: plain values.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sundog {

/// Global and local size of a launch. The global size is padded to whole work-groups; kernels check their
/// index against the count they are given. local = {0, 0}: the driver's own choice.
struct LaunchSize {
  std::size_t x = 1, y = 1;
  std::size_t local_x = 64, local_y = 1;
};

/// A launch of one work-group that does nothing, by which some drivers make a kernel's machine code before it
/// is wanted. Every argument is zero, and a buffer is a few pages of zeros: the kernel must take that for no
/// work.
struct EmptyLaunch {
  std::string kernel;
  std::size_t local_x = 1, local_y = 1;
  std::vector<std::size_t> argument_bytes;  // 0: a buffer
};

/// Sum of the launches of one kernel on one device. device_ms comes from events and is 0 where the driver
/// gives none. host_ms is by the host's clock, from the first enqueue of a batch to the end of finish(),
/// shared among the batch's launches as their event times are (equally where there are none). first_ms is the
/// part of host_ms beyond the events where a launch was the first of its local size: drivers compile or load
/// the kernel then. The local sizes are those of the last launch; 0: the driver's.
struct KernelTimes {
  std::uint64_t launches = 0;
  double device_ms = 0, host_ms = 0, first_ms = 0;
  std::size_t local_x = 0, local_y = 0;
};

/// Seconds that a driver spent before first launches ran, of all kernels.
inline double first_launch_seconds(const std::map<std::string, KernelTimes>& kernels) {
  double milliseconds = 0;
  for (const auto& [name, times] : kernels) milliseconds += times.first_ms;
  return 1e-3 * milliseconds;
}

}  // namespace sundog
