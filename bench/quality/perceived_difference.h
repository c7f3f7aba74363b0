// How different two pictures look to someone who flips between them, after Andersson and others 2020, "FLIP:
// A Difference Evaluator for Alternating Images".
#pragma once
#include <vector>

#include "base/image.h"

namespace sundog {

/// For each pixel, 0 (looks the same) to 1. Colours above 1 count as 1, below 0 or not finite as 0. Both
/// images have the same size and at least 3 channels of linear colour (std::invalid_argument otherwise).
std::vector<float> perceived_differences(const Image& a, const Image& b);

/// The mean of perceived_differences(); 0 for empty images.
double perceived_difference(const Image& a, const Image& b);

}  // namespace sundog
