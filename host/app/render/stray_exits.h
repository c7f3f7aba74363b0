// Explains why rays left solids that they had not entered, for warnings.
#pragma once
#include <string>
#include <vector>

#include "render/values/report.h"
#include "scene/description.h"

namespace sundog {

/// "in at most 12 pixels (0.4 %)": the pixels whose rays lost count of the media they are in. At most,
/// because each pass over the frame counts its pixels again.
std::string lost_pixels(const RayCounts& counts, const SceneDescription& scene);

/// Sentences about such rays and their pixels that name the objects at fault: meshes that are inside out or
/// not closed, and shapes without an interior. If there are none, surfaces may coincide, so all objects with
/// an interior are named. Long lists are shortened.
std::vector<std::string> explain_stray_exits(const RayCounts& counts, const SceneDescription& scene);

}  // namespace sundog
