// Why rays left solids that they had not entered.
#pragma once
#include <string>
#include <vector>

#include "render/values/report.h"
#include "scene/description.h"

namespace sundog {

/// "in at most 12 pixels (0.4 %)": those with rays that lost count of the media they are in. Each
/// pass over the frame counts anew.
std::string lost_pixels(const RayCounts& counts, const SceneDescription& scene);

/// Sentences about such rays and their pixels, which name the objects at fault: meshes that are inside out,
/// meshes that are not closed, shapes without an inside. Where none is, surfaces may coincide: all objects
/// with an interior are then named. Long lists are shortened.
std::vector<std::string> explain_stray_exits(const RayCounts& counts, const SceneDescription& scene);

}  // namespace sundog
