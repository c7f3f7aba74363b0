// How different two pictures look to someone who flips between them, after Andersson and others 2020, "FLIP:
// A Difference Evaluator for Alternating Images".
#pragma once
#include <vector>

#include "base/image.h"

namespace sundog {

/// A viewer's pixels per degree: a monitor 0.7 m wide with 3840 pixels, seen from 0.7 m.
inline constexpr double usual_pixels_per_degree = 67;

/// For each pixel 0 (looks the same) to 1. Values above 1 count as 1, below 0 and not finite as 0. Both
/// images have the same size and at least 3 channels of linear colour (std::invalid_argument otherwise).
std::vector<float> perceived_differences(const Image& a, const Image& b,
                                         double pixels_per_degree = usual_pixels_per_degree);

/// Their mean.
double perceived_difference(const Image& a, const Image& b,
                            double pixels_per_degree = usual_pixels_per_degree);

}  // namespace sundog
