// Adds bloom: light that a camera's lens spreads around bright parts.
#pragma once
#include "base/image.h"

namespace sundog {

/// Spreads `share`, 0..1, of each pixel's light over its surroundings by the mean of three Gaussians with
/// standard deviations of 1/200, 1/50 and 1/12 of the picture's longer side. Changes only the first three
/// channels. Non-finite values count as black and are unchanged.
void add_bloom(Image& image, double share);

}  // namespace sundog
