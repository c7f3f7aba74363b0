// How much two linear pictures differ.
#pragma once
#include "base/image.h"

namespace sundog::povray {

/// Of the pixels' greatest channel difference, both pictures clamped to [0, 1].
struct Difference {
  double mean = 0, median = 0, percentile_99 = 0, greatest = 0;
  double share_above_1_percent = 0;  // of the pixels
  Image picture;                     // the difference of each channel, eight times as strong
};

/// Throws std::invalid_argument for pictures of different sizes.
Difference difference(const Image& a, const Image& b);

}  // namespace sundog::povray
