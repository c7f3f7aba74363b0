// Smaller copies of images, each half as wide and high as the one before, averaged in linear light (Williams
// 1983, "Pyramidal Parametrics").
#pragma once
#include <functional>
#include <vector>

#include "base/pixels/stored_image.h"

namespace sundog {

/// Makes samples what textures take: bytes of colours sRGB, words of colours linear halves; bytes and words
/// of data stay as they are, and a file's own exponent is spent.
void settle_samples(StoredImage& image, bool srgb);

/// What an image's samples are, which says how levels are averaged.
enum class SampleUse {
  data,
  color,
  color_by_alpha  // colours count by their alpha, so that what cannot be seen does not bleed
};

/// A row of a level's samples; level 0 is the image.
using TakeRow = std::function<void(std::size_t level, int y, const std::uint8_t* samples)>;

/// Makes the levels after `image`, down to one pixel, and passes on each row of all once, from several
/// threads. Odd edges are divided with three weights a pixel, so that the mean stays (Guthe and Heckbert
/// 2005, "Non-Power-of-Two Mipmapping").
void each_level_row(const StoredImage& image, SampleUse use, const TakeRow& take);

/// The levels after `image`.
std::vector<StoredImage> smaller_levels(const StoredImage& image, SampleUse use);

/// The first of them alone; the image has more than one pixel.
StoredImage half_size(const StoredImage& image, SampleUse use);

}  // namespace sundog
