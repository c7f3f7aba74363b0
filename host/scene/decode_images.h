// Decodes a scene's images, after all have been collected.
#pragma once
#include "scene/description.h"

namespace sundog {

class FrameCache;

/// Decodes all images in parallel; keeps images of equal bytes and use once. If they take more than
/// `render.texture_memory` together, halves the largest ones, with a warning for each. A model's image that
/// cannot be decoded becomes white, with a warning. `cache` holds the images of earlier frames. Throws
/// SceneError with the image's file and place.
void decode_images(SceneDescription& scene, FrameCache* cache = nullptr);

}  // namespace sundog
