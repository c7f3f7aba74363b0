// Adds an ordered threshold to each value before it is rounded to 8 bits.
#include "base/pixels/dither.h"

#include <algorithm>
#include <cstdint>

#include "base/image_io.h"
#include "base/parallel.h"
#include "base/pixels/image_levels.h"

namespace sundog {
namespace {

/// A threshold in (0, 1), spread evenly over neighbours so that no pattern shows: the additive recurrence of
/// the plastic number in two dimensions, folded (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
/// Sequences"). It stays away from 0 and 1, so that rounding does not move exact 8-bit values.
double dither_threshold(std::size_t x, std::size_t y, std::size_t channel) {
  const auto turn = static_cast<std::uint32_t>(x * 3242174889u + y * 2447445413u + channel * 1431655765u);
  const std::uint32_t folded = turn < 0x80000000u ? turn * 2 : ~turn * 2;
  return (double(folded >> 24) + 0.5) / 256;
}

}  // namespace

void dither_to_8_bits(Image& image) {
  const auto channels = static_cast<std::size_t>(image.channels),
             width = static_cast<std::size_t>(image.width);
  const auto& bytes = linear_bytes();
  in_parallel(image.data.size() / channels, [&](std::size_t pixel) {
    for (std::size_t channel = 0; channel < std::min<std::size_t>(channels, 3); ++channel) {
      float& value = image.data[pixel * channels + channel];
      if (!(value > 0 && value < 1)) continue;
      const double up = dither_threshold(pixel % width, pixel / width, channel);
      value = bytes[static_cast<std::size_t>(255 * double(srgb_from_linear(value)) + up)];
    }
  });
}

}  // namespace sundog
