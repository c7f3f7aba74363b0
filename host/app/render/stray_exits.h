// Why rays left solids that they had not entered.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// Sentences about `count` such rays, which name the objects at fault: meshes that are inside out, meshes
/// that are not closed, shapes without an inside. Where none is, surfaces may coincide: all objects with an
/// interior are then named. Long lists are shortened.
std::vector<std::string> explain_stray_exits(std::uint64_t count, const SceneDescription& scene);

}  // namespace sundog
