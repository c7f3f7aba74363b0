// The next frame's camera and the motion of objects until then.
#pragma once
#include "base/pixels/shot.h"
#include "scene/description.h"

namespace sundog {

/// Pairs objects by index. Without `next`, uses the scene as its shutter closes.
NextShot next_shot(const SceneDescription& now, const SceneDescription* next);

}  // namespace sundog
