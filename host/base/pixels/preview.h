// A picture on its way to a screen, where speed counts more than the last bit.
#pragma once
#include <string>

#include "base/image.h"

namespace sundog {

/// A JPEG of `quality` 1..100, colours clipped to [0, 1] as sRGB, alpha left out. Throws std::runtime_error.
std::string encode_preview(const Image& image, int quality);

}  // namespace sundog
