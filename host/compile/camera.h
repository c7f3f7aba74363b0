// The camera's frame and pixel vectors, the background, and the settings of SceneInfo.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

/// Fills the camera, background, size and settings of `info`; its positions count from `origin`.
/// Throws SceneError for an empty image, and for a view without a direction or an up that lies along it.
void set_camera(const SceneDescription& scene, const dvec3& origin, SceneInfo& info);

}  // namespace sundog
