// Sample values of one sample: pure functions of pixel, sample and dimension (listed in shared/sampler.h).
#pragma once
#include "shared/sampler.h"
#include "shared/types.h"

// Distribution of samples in pixels: a SAMPLER_* constant.
#ifndef SAMPLER
#define SAMPLER SAMPLER_AUTO
#endif

#ifndef SAMPLE_ROOM
#define SAMPLE_ROOM 0u
#endif

// [0, 1), 24 bits.
static inline float unit_float(u32 bits) { return (float)(bits >> 8) * 0x1p-24f; }

// The cell of sample `sample` in a nearly square grid of `samples` cells; `in_cell` is the position in it.
static inline float2 grid_cell(u32 sample, u32 samples, float2 in_cell) {
  u32 columns = (u32)sqrt((float)samples + 0.5f);
  while (samples % columns) --columns;
  const u32 rows = samples / columns;
  const float2 at = (float2)((float)(sample / rows), (float)(sample % rows)) + in_cell;
  return fmin(at / (float2)((float)columns, (float)rows), (float2)(0x1.fffffep-1f));
}

// The position of a camera sample in its pixel, in [0, 1)^2, for samplers with a grid.
static inline float2 place_in_grid(uint2 pixel, u32 sample, u32 samples, u32 frame_seed) {
  if (SAMPLER == SAMPLER_REGULAR) return grid_cell(sample, samples, (float2)(0.5f));
  const u32 seed = hash_pixel(pixel.x, pixel.y, DIMENSION_PIXEL + frame_seed);
  return grid_cell(
      sample, samples,
      (float2)(unit_float(hash_u32(seed + 2u * sample)), unit_float(hash_u32(seed + 2u * sample + 1u))));
}
