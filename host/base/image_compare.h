// Compares two images of equal size: gives statistics and a picture of the differences.
#pragma once
#include <cstdint>

#include "base/image.h"

namespace sundog {

/// Absolute differences of linear values, over the first channels (red, green, blue by default). A pixel's
/// difference is its worst channel's. A non-finite value differs by infinity from every value except itself
/// (NaN equals NaN).
struct ImageDifference {
  double mean = 0, rms = 0;          // over all finite channel differences
  double max = 0;                    // over pixels; may be infinite
  double percentile_99 = 0;          // 99 % of the pixels differ by no more; may be infinite
  double psnr = 0;                   // decibels, peak 1; infinite for equal images
  std::uint64_t pixels = 0;          // number in each image
  std::uint64_t differing = 0;       // pixels that differ at all
  std::uint64_t over_tolerance = 0;  // pixels that differ by more than the tolerance
  std::uint64_t non_finite = 0;      // pixels with a non-finite value in either image
};

/// Compares the first `channels` channels; 4 includes alpha. Throws std::invalid_argument unless both images
/// have the same size and that many channels.
ImageDifference compare_images(const Image& a, const Image& b, double tolerance, int channels = 3);

/// Returns `a` dimmed to grey, with differing pixels coloured by a logarithmic scale: blue (1e-5 and less),
/// cyan (3e-4), green, yellow (3e-2), red (1 and more), magenta (non-finite).
Image difference_image(const Image& a, const Image& b, int channels = 3);

}  // namespace sundog
