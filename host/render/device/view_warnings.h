// Warns about views that exceed the precision of floats or a device's capabilities.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "scene/description.h"

namespace sundog {

/// One warning per problem, with the remedy: a deep view of a field on a device without doubles, or beyond
/// their precision; a field of view so narrow that pixels differ by less than floats resolve; objects so
/// large relative to their distance that floats do not resolve details near them.
std::vector<std::string> view_warnings(const SceneDescription& scene, const CompiledScene& flat,
                                       std::span<const DeviceInfo> devices);

}  // namespace sundog
