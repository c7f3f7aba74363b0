// Bloom: light that a camera's glass spreads over the surroundings of bright parts.
#pragma once
#include "base/image.h"

namespace sundog {

/// Spreads `share`, 0..1, of each pixel's light over its surroundings: the mean of three bells whose standard
/// deviations are 1/200, 1/50 and 1/12 of the picture's longer side. Only the first three channels change.
/// Values that are not finite count as black and stay.
void add_bloom(Image& image, double share);

}  // namespace sundog
