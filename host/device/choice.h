// How devices are driven and chosen, in words for people.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "device/devices.h"

namespace sundog {

/// Whether a device takes many rays a work-item with explicit vectors (the "wide" tracer), rather than one
/// ray a lane (the "compact" one).
bool wants_vectors(const DeviceInfo& device);

/// Whether its compiler keeps functions that are called from many places apart. Mesa's writes each call out:
/// the interpreter of fields (kernels/lib/sdf/interpret.cl) then takes it minutes.
bool calls_functions(const DeviceInfo& device);

/// "0:0 ... (estimate 48000), before 1:0 ... (600)": which device is the default, and by which estimates.
std::string choice_text(std::span<const DeviceInfo> all, const DeviceInfo& chosen);

}  // namespace sundog
