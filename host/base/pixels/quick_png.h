// Fast PNG encoding for previews: same pixels as encode_png(), in somewhat larger files. With the same filter
// and its fastest level, libspng takes 2.2 times as long.
#pragma once
#include <cstdint>
#include <string>

#include "base/image.h"

namespace sundog {

/// 8-bit sRGB without alpha. Throws std::runtime_error for an image beyond 2^30 bytes.
std::string encode_quick_png(const Image& image);

/// lround(255 * srgb_from_linear(value)), clamped to 0..255, 0 for NaN; uses comparisons only.
std::uint8_t srgb_byte(float value);

}  // namespace sundog
