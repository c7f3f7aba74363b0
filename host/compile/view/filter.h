// Reconstruction filters: the weight of a sample by its distance from the pixel's centre. Camera samples are
// placed with the filter's density, so that all have equal weight (filter importance sampling: Ernst,
// Stamminger and Greiner 2006).
#pragma once
#include <vector>

#include "scene/description.h"

namespace sundog {

/// The filter's 1D value at distance `x` from the centre, up to a factor; 0 beyond its radius. Filters are
/// separable products of it.
double filter_value(Filter filter, double radius, double x);

/// The radius in pixels; the filter's default if the settings give none.
double filter_radius(const RenderSettings& settings);

/// The table for filter_offset() in kernels/plain/path/lens.cl (shared/filter.h); empty for a box of one
/// pixel, which needs none.
std::vector<float> filter_table(const RenderSettings& settings);

}  // namespace sundog
