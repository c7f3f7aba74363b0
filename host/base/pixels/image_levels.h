// Computes mip levels of images, each half as wide and high as the previous level, averaged in linear light
// (Williams 1983, "Pyramidal Parametrics").
#pragma once
#include <array>
#include <functional>

#include "base/pixels/stored_image.h"

namespace sundog {

/// Linear values of the 256 sRGB bytes.
const std::array<float, 256>& linear_bytes();

/// Converts samples for textures: colour bytes to sRGB, colour words to linear halves. Data bytes and words
/// are unchanged. Applies and drops the file's exponent.
void settle_samples(StoredImage& image, bool srgb);

/// The meaning of an image's samples; decides how they are averaged.
enum class SampleUse {
  data,
  color,
  color_by_alpha  // colours are weighted by alpha, so that invisible ones do not bleed
};

/// Receives a row of a level's samples; level 0 is the image.
using TakeRow = std::function<void(std::size_t level, int y, const std::uint8_t* samples)>;

/// Computes the levels after `image`, down to one pixel, and passes each row once, from several threads. Odd
/// edges use three weights per pixel to preserve the mean (Guthe and Heckbert 2005, "Non-Power-of-Two
/// Mipmapping").
void each_level_row(const StoredImage& image, SampleUse use, const TakeRow& take);

/// The first level after `image`, which must have more than one pixel.
StoredImage half_size(const StoredImage& image, SampleUse use);

}  // namespace sundog
