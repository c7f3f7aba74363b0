// What a view asks of floats, or of a device, that they have not.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "scene/description.h"

namespace sundog {

/// Each with its mend: a deep view of a field on a device without doubles, or from nearer than doubles go; a
/// field seen through so narrow an angle of view that pixels differ by less than floats do; objects so large
/// beside their distance that floats do not tell what lies close to them.
std::vector<std::string> view_warnings(const SceneDescription& scene, const CompiledScene& flat,
                                       std::span<const DeviceInfo> devices);

}  // namespace sundog
