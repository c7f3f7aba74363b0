// Estimates the error of a film's pixels relative to infinitely many samples.
#pragma once
#include <vector>

#include "render/film/pass.h"

namespace sundog {

/// Expected squared errors of `pixels` (x | y << 16) with `level` samples (1 or a power of two), in units of
/// squared pixel_errors(). Three indicators: the pixel's change when its samples double, its neighbours'
/// change (Dammertz et al. 2010), and the variance of nearby colours, because a pixel's few samples may all
/// miss an edge.
std::vector<float> expected_squares(const Film& film, const std::vector<u32>& pixels, u32 level);

/// expected_squares() of noisy pixels, from the mean change in the 5x5 pixels around. A pixel whose samples
/// all miss a rare bright light changes little and is too dark. If its own change decided, it would stay so,
/// and the picture would be too dark.
std::vector<float> pooled_squares(const Film& film, const std::vector<u32>& pixels, u32 level);

/// Expected squared errors of all pixels, row by row, at one sample each.
std::vector<float> expected_squares_of_one(const Film& film);

/// Relative number of rays per sample in each block of pixels, with mean 1; all 1 if rays were not counted.
/// Expensive samples must reduce more error.
std::vector<float> block_costs(const Film& film);

}  // namespace sundog
