// Reconstruction filters: how far from its pixel's centre a sample's light counts for the pixel, and how
// much. Camera samples are placed by the filter's own density, so that each counts the same (filter
// importance sampling: Ernst, Stamminger and Greiner 2006).
#pragma once
#include <vector>

#include "scene/description.h"

namespace sundog {

/// The filter's value at the distance `x` along an axis from the centre, up to a factor; 0 beyond its radius.
/// Filters are products of this for both axes.
double filter_value(Filter filter, double radius, double x);

/// The radius in pixels, the filter's own where the settings name none.
double filter_radius(const RenderSettings& settings);

/// The table filter_offset() of kernels/lib/core/filter.cl reads; empty for a box of one pixel, which needs
/// none. See shared/filter.h.
std::vector<float> filter_table(const RenderSettings& settings);

}  // namespace sundog
