// Colours on their way to 8 bits: gradients show no steps.
#pragma once

#include "base/image.h"

namespace sundog {

/// Sets the first three channels, linear, to values that 8 bits in sRGB hold: rounded up or down by chance,
/// in proportion to where a colour lies between two levels, so that means stay. Chance is a function of the
/// pixel's place and the channel; what 8 bits hold already, 0, 1 and what is beyond them stays.
void dither_to_8_bits(Image& image);

}  // namespace sundog
