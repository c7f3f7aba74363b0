// Reconstruction filters: where camera samples lie about their pixels' centres (shared/filter.h).
#ifndef SUNDOG_LIB_FILTER_CL
#define SUNDOG_LIB_FILTER_CL
#include "shared/filter.h"
#include "shared/types.h"

// How far along an axis from the centre the sample value u in [0, 1) lies. `sign` is multiplied by the sign
// of the filter there.
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

// Takes the place (*x, *y) in a pixel's square to one in the reach of the filter; 1.0 or -1.0 is what a
// sample there counts.
static inline float filter_place(__global const float* restrict table, u32 samples, float* x, float* y) {
  float sign = 1.0f;
  if (HAS_FILTER && samples > 1u) {
    *x = 0.5f + filter_offset(table, *x, &sign);
    *y = 0.5f + filter_offset(table, *y, &sign);
  }
  return sign;
}

#endif
