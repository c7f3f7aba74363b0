// How far the pixels of a growing film are from what they would be with endless samples.
#pragma once
#include <vector>

#include "render/film/growing_film.h"

namespace sundog {

/// The expected squared errors of `pixels` (x | y << 16), those with `level` samples, which are one or a
/// power of two. In the units of the square of pixel_errors(). Three things speak of it: how far doublings
/// moved the pixel, how far they moved its neighbours (Dammertz and others 2010), and how much colours vary
/// about it, since a pixel whose few samples fell on one side of an edge does not know of the edge.
std::vector<float> expected_squares(const GrowingFilm& film, const std::vector<u32>& pixels, u32 level);

/// The same of all pixels, row by row, where each has one sample.
std::vector<float> expected_squares_of_one(const GrowingFilm& film);

/// How many rays the samples in each block of pixels take, in the mean 1, where those were counted; else 1
/// each. Where samples are dear, each must take away more error.
std::vector<float> block_costs(const GrowingFilm& film);

}  // namespace sundog
