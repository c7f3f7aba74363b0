// Compiles the camera's frame and pixel vectors, the background, and the settings of SceneInfo.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

/// Sets the camera, background, size and settings of `info`; positions are relative to `origin`. Throws
/// SceneError for an empty image, a zero view direction, or an up vector parallel to it.
void set_camera(const SceneDescription& scene, const dvec3& origin, SceneInfo& info);

}  // namespace sundog
