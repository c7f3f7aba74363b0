// What a launch is enqueued with, and what launches took: plain values.
#pragma once
#include <cstddef>
#include <cstdint>

namespace sundog {

/// Global and local size of a launch. The global size is padded to whole work-groups; kernels check their
/// index against the count they are given. local = {0, 0}: the driver's own choice.
struct LaunchSize {
  std::size_t x = 1, y = 1;
  std::size_t local_x = 64, local_y = 1;
};

/// Sum of the launches of one kernel on one device. device_ms comes from events and is 0 where the driver
/// gives none. host_ms is by the host's clock, from the first enqueue of a batch to the end of finish(),
/// shared among the batch's launches as their event times are (equally where there are none). The local sizes
/// are those of the last launch; 0: the driver's.
struct KernelTimes {
  std::uint64_t launches = 0;
  double device_ms = 0, host_ms = 0;
  std::size_t local_x = 0, local_y = 0;
};

}  // namespace sundog
