// The next frame's camera and the motion of objects until then.
#pragma once
#include "base/pixels/shot.h"
#include "scene/description.h"

namespace sundog {

/// Objects are paired by their index. Without `next` it is the scene as its shutter closes.
NextShot next_shot(const SceneDescription& now, const SceneDescription* next);

}  // namespace sundog
