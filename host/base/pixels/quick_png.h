// A PNG on its way to a screen: the pixels of encode_png(), several times as fast, in a somewhat larger file.
#pragma once
#include <cstdint>
#include <string>

#include "base/image.h"

namespace sundog {

/// 8 bits a channel as sRGB, alpha left out. Throws std::runtime_error for an image beyond 2^30 bytes.
std::string encode_quick_png(const Image& image);

/// lround(255 * srgb_from_linear(value)), from 0 to 255, and 0 for what is no number: by comparisons alone.
std::uint8_t srgb_byte(float value);

}  // namespace sundog
