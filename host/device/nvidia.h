// Parses the kernel statistics in NVIDIA's build log (-cl-nv-verbose), and computes the occupancy of a
// multiprocessor.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace sundog {

/// Statistics of one kernel. Stack and spills are bytes per work-item, including listed callees.
struct PtxasFigures {
  std::optional<std::uint64_t> registers, stack, spill_stores, spill_loads;
};

/// Kernel -> statistics, from the ptxas lines of a build log; empty without them.
std::map<std::string, PtxasFigures> read_ptxas_log(const std::string& log);

/// Limits of a multiprocessor, from the driver (cl_nv_device_attribute_query) or the compute capability.
struct NvidiaLimits {
  unsigned major = 0, minor = 0;  // compute capability
  unsigned registers = 65536;     // CL_DEVICE_REGISTERS_PER_BLOCK_NV
  unsigned warp = 32;             // CL_DEVICE_WARP_SIZE_NV
  unsigned threads() const;       // maximum resident threads, by compute capability (there is no query)
};

/// Resident threads of a multiprocessor when each uses this many registers: registers are allocated to whole
/// warps in steps of 256, and each of the four schedulers has a quarter.
unsigned resident_threads(std::uint64_t registers, const NvidiaLimits& limits);

}  // namespace sundog
