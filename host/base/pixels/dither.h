// Dithers images to 8 bits, so that gradients show no bands.
#pragma once

#include "base/image.h"

namespace sundog {

/// Rounds the first three channels, linear, to values that 8-bit sRGB represents exactly. Rounds up or down
/// with a probability that preserves the mean; the random number depends only on the pixel and the channel.
/// Values that 8 bits represent exactly, and those outside 0..1, are unchanged.
void dither_to_8_bits(Image& image);

}  // namespace sundog
