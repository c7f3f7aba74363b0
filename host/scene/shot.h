// The camera of a scene as a picture's file states it.
#pragma once
#include <optional>

#include "base/pixels/shot.h"
#include "scene/description.h"

namespace sundog {

/// The camera as the shutter opens; `frame` of a film.
Shot shot_of(const SceneDescription& scene, std::optional<double> frame = std::nullopt);

}  // namespace sundog
