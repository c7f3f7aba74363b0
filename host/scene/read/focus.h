// Focuses the camera on a named object.
#pragma once
#include <span>

#include "scene/description.h"

namespace sundog {

/// Sets the lens's focus to the depth of the middle of the bounding box of `objects` or, if there are none,
/// of the models' objects with the name `focus_on`. Throws SceneError if there are none either, or if the
/// middle is not in front of the camera.
void focus_on_object(SceneDescription& scene, std::span<const Object> objects);

/// Sets the lens's focus to the depth of its `focus_point`.
void focus_on_point(SceneDescription& scene);

}  // namespace sundog
