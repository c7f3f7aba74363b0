// Decides which kernels suit a device, and explains why the default device was chosen.
#pragma once
#include <span>
#include <string>

#include "device/devices.h"

namespace sundog {

/// Whether a device traces many rays per work-item with explicit vectors (the "wide" tracer) instead of one
/// ray per lane (the "compact" one): device_rules.h.
bool wants_vectors(const DeviceInfo& device);

/// Whether the device's compiler keeps function calls (device_rules.h). If not, the interpreter of distance
/// fields (kernels/lib/sdf/interpret.cl) is not built.
bool calls_functions(const DeviceInfo& device);

/// "0:0 ... (estimate 48000), before 1:0 ... (600)": the default device and the deciding estimates.
std::string choice_text(std::span<const DeviceInfo> all, const DeviceInfo& chosen);

}  // namespace sundog
