// Decodes a scene's images once all are known.
#pragma once
#include "scene/description.h"

namespace sundog {

/// Default memory limit for a scene's images on a device, in bytes.
inline constexpr std::size_t default_texture_bytes = std::size_t{1} << 30;

/// Decodes all images in parallel; duplicates for the same use are stored once. While they exceed
/// `render.texture_memory`, halves the largest, with a warning each. Throws SceneError with the image's file
/// and place.
void decode_images(SceneDescription& scene);

}  // namespace sundog
