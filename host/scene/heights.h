// Numbers of textures at points, computed by the host: what kernels sample, without smaller levels.
#pragma once
#include "scene/description.h"

namespace sundog {

/// The number that an image texture gives at (u, v), v up: bilinear, or the nearest texel.
double texture_number(const SceneDescription& scene, const TextureDescription& texture, glm::dvec2 uv);

}  // namespace sundog
