// Estimates speed. OpenCL reports no lane count for GPUs and misleading values for emulators, so both are
// guessed from other properties.
#include "device/estimate.h"

#include <algorithm>

namespace sundog {
namespace {

// Lanes of a GPU compute unit: 32 to 128 on a discrete chip, 8 to 64 if it shares the host's memory.
constexpr double discrete_lanes = 64, integrated_lanes = 16;

// A CPU that reports neither vectors nor a cache is emulated: llvmpipe and Oclgrind do so, PoCL and vendors'
// CPU drivers do not. The fastest emulated device (llvmpipe) traced rays 40 to 80 times slower than PoCL.
constexpr double emulation_penalty = 1.0 / 40;

// Virtual machines often report no clock rate.
constexpr double assumed_clock_mhz = 1000;

bool is_emulated(const DeviceInfo& device) {
  return device.type == "cpu" && device.native_vector_width <= 1 && device.cache == 0;
}

double lanes(const DeviceInfo& device) {
  if (device.type == "cpu" || device.native_vector_width > 1) return std::max(device.native_vector_width, 1u);
  return device.host_unified_memory ? integrated_lanes : discrete_lanes;
}

}  // namespace

DeviceClass device_class(const DeviceInfo& device) {
  return device.type == "cpu" || device.native_vector_width > 1 ? DeviceClass::cpu : DeviceClass::gpu;
}

double estimate_speed(const DeviceInfo& device, unsigned host_threads) {
  unsigned units = std::max(device.compute_units, 1u);
  if (device.type == "cpu" && host_threads > 0) units = std::min(units, host_threads);
  const double clock = device.clock_mhz > 0 ? device.clock_mhz : assumed_clock_mhz;
  return units * clock * lanes(device) * (is_emulated(device) ? emulation_penalty : 1.0);
}

}  // namespace sundog
