// Smaller copies of images, each half as wide and high as the one before, averaged in linear light (Williams
// 1983, "Pyramidal Parametrics").
#pragma once
#include <vector>

#include "base/pixels/stored_image.h"

namespace sundog {

/// Makes samples what textures take: bytes of colours sRGB, words of colours linear halves; bytes and words
/// of data stay as they are, and a file's own exponent is spent.
void settle_samples(StoredImage& image, bool srgb);

/// The levels after `image`, down to one pixel. Colours (`srgb`) count by their alpha, so that what cannot be
/// seen does not bleed. Odd edges are divided with three weights a pixel, so that the mean stays (Guthe and
/// Heckbert 2005, "Non-Power-of-Two Mipmapping").
std::vector<StoredImage> smaller_levels(const StoredImage& image, bool srgb);

/// The first of them alone.
StoredImage half_size(const StoredImage& image, bool srgb);

}  // namespace sundog
