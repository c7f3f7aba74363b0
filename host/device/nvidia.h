// What NVIDIA's compiler says of a kernel in its build log (with -cl-nv-verbose), and how many threads a
// multiprocessor holds by it.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace sundog {

/// Of one kernel. Stack and spills are bytes a work-item, its functions' that the log lists with it included.
struct PtxasFigures {
  std::optional<std::uint64_t> registers, stack, spill_stores, spill_loads;
};

/// Kernel -> figures, from the lines of ptxas in a build log; empty for a log without them.
std::map<std::string, PtxasFigures> read_ptxas_log(const std::string& log);

/// Of one multiprocessor, as the driver tells (cl_nv_device_attribute_query) or the compute capability says.
struct NvidiaLimits {
  unsigned major = 0, minor = 0;  // compute capability
  unsigned registers = 65536;     // CL_DEVICE_REGISTERS_PER_BLOCK_NV
  unsigned warp = 32;             // CL_DEVICE_WARP_SIZE_NV
  unsigned threads() const;       // that may be resident: no query tells, so by the compute capability
};

/// Threads that may be resident on a multiprocessor when each has this many registers: registers go to whole
/// warps in steps of 256, and a quarter of the multiprocessor's to each of its four schedulers.
unsigned resident_threads(std::uint64_t registers, const NvidiaLimits& limits);

}  // namespace sundog
