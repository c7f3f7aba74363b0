// Decodes a scene's images once all are known.
#pragma once
#include "scene/description.h"

namespace sundog {

class FrameCache;

/// Decodes all images, several at a time; one that is there twice for the same use is kept once. Images that
/// together take more than `render.texture_memory`, the greatest first, are halved, with a warning each.
/// `cache` has those of the frames before. Throws SceneError with the image's file and place.
void decode_images(SceneDescription& scene, FrameCache* cache = nullptr);

}  // namespace sundog
