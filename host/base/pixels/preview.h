// Fast JPEG encoding for previews.
#pragma once
#include <string>

#include "base/image.h"

namespace sundog {

/// A JPEG of `quality` 1..100 in sRGB, clipped to [0, 1], without alpha. Throws std::runtime_error.
std::string encode_preview(const Image& image, int quality);

}  // namespace sundog
