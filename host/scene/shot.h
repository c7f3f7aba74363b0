// A scene's camera, as image files store it.
#pragma once
#include <optional>

#include "base/pixels/shot.h"
#include "scene/description.h"

namespace sundog {

/// The camera when the shutter opens; `frame`: the frame's number in an animation.
Shot shot_of(const SceneDescription& scene, std::optional<double> frame = std::nullopt);

}  // namespace sundog
