// Samples texture values on the host, as kernels do, but without mip levels.
#pragma once
#include "scene/description.h"

namespace sundog {

/// The value of an image texture at (u, v), v up, filtered bilinearly or nearest.
double texture_number(const SceneDescription& scene, const TextureDescription& texture, glm::dvec2 uv);

}  // namespace sundog
