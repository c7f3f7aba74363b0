// Reconstruction filters: offsets of camera samples from pixel centres (shared/filter.h).
#pragma once
#include "shared/filter.h"
#include "shared/types.h"

// The offset along an axis for the sample value u in [0, 1). Multiplies `sign` by the filter's sign there.
static inline float filter_offset(__global const float* restrict table, float u, float* sign) {
  const float below = table[0];
  const bool lobe = u < below;
  const float side = 2.0f * (lobe ? u / below : (u - below) / (1.0f - below)) - 1.0f;
  const float at = fabs(side) * (float)FILTER_STEPS;
  const u32 step = min((u32)at, (u32)FILTER_STEPS - 1u);
  __global const float* distances = table + (lobe ? FILTER_BELOW : FILTER_ABOVE) + step;
  if (lobe) *sign = -*sign;
  return copysign(distances[0] + (at - (float)step) * (distances[1] - distances[0]), side);
}

// Maps the place (*x, *y) in a pixel's square to the filter's support; returns the sample's weight, 1.0 or
// -1.0.
static inline float filter_place(__global const float* restrict table, u32 samples, float* x, float* y) {
  float sign = 1.0f;
  if (HAS_FILTER && samples > 1u) {
    *x = 0.5f + filter_offset(table, *x, &sign);
    *y = 0.5f + filter_offset(table, *y, &sign);
  }
  return sign;
}
