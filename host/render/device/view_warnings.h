// What a view asks of floats, or of a device, that they have not.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {

/// Each with its mend: a deep view of a field on a device without doubles, and a field seen through so narrow
/// an angle of view that pixels differ by less than floats do.
std::vector<std::string> view_warnings(const CompiledScene& scene, std::span<const DeviceInfo> devices);

}  // namespace sundog
