// Sample values: pure functions of pixel, sample and dimension. shared/sampler.h lists the dimensions.
#ifndef SUNDOG_LIB_SAMPLER_CL
#define SUNDOG_LIB_SAMPLER_CL
#include "shared/sampler.h"
#include "shared/types.h"

// Where samples lie in their pixels: a SAMPLER_* constant.
#ifndef SAMPLER
#define SAMPLER SAMPLER_AUTO
#endif

#ifndef SAMPLE_ROOM
#define SAMPLE_ROOM 0u
#endif

// [0, 1), 24 bits.
static inline float unit_float(u32 bits) { return (float)(bits >> 8) * 0x1p-24f; }

// A number in [0, 1) for a dimension of a pixel's sample.
static inline float sample_1d(uint2 pixel, u32 sample, u32 dimension) {
  if (SAMPLER == SAMPLER_BLUE_NOISE)
    return unit_float(blue_noise_bits(pixel.x, pixel.y, sample, SAMPLE_ROOM, dimension));
  return unit_float(SAMPLER == SAMPLER_INDEPENDENT
                        ? hash_u32(sample + hash_pixel(pixel.x, pixel.y, dimension))
                        : sobol_bits(pixel.x, pixel.y, sample, dimension));
}

// Two numbers in [0, 1) for the dimensions `dimension` and `dimension` + 1.
static inline float2 sample_2d(uint2 pixel, u32 sample, u32 dimension) {
  return (float2)(sample_1d(pixel, sample, dimension), sample_1d(pixel, sample, dimension + 1u));
}

// Hammersley's set of `samples` points, shifted per pixel (Cranley and Patterson 1976).
static inline float2 hammersley(uint2 pixel, u32 sample, u32 samples) {
  const float a = ((float)sample + 0.5f) / (float)samples + unit_float(hash_pixel(pixel.x, pixel.y, 0u));
  const float b = unit_float(reversed_bits(sample) + hash_pixel(pixel.x, pixel.y, 1u));
  return (float2)(fmin(a - floor(a), 0x1.fffffep-1f), b);
}

// The cell of sample `sample` in a grid of `samples` cells that is as square as they allow; `in_cell` is the
// place in it.
static inline float2 grid_cell(u32 sample, u32 samples, float2 in_cell) {
  u32 columns = (u32)sqrt((float)samples + 0.5f);
  while (samples % columns) --columns;
  const u32 rows = samples / columns;
  const float2 at = (float2)((float)(sample / rows), (float)(sample % rows)) + in_cell;
  return fmin(at / (float2)((float)columns, (float)rows), (float2)(0x1.fffffep-1f));
}

// Where a camera sample lies in its pixel, in [0, 1) each way: in the middle for one sample.
static inline float2 pixel_sample(uint2 pixel, u32 sample, u32 samples) {
  if (samples <= 1u) return (float2)(0.5f);
  if (SAMPLER == SAMPLER_AUTO) return hammersley(pixel, sample, samples);
  if (SAMPLER == SAMPLER_REGULAR) return grid_cell(sample, samples, (float2)(0.5f));
  if (SAMPLER != SAMPLER_STRATIFIED) return sample_2d(pixel, sample, DIMENSION_PIXEL);
  const u32 seed = hash_pixel(pixel.x, pixel.y, DIMENSION_PIXEL);
  return grid_cell(
      sample, samples,
      (float2)(unit_float(hash_u32(seed + 2u * sample)), unit_float(hash_u32(seed + 2u * sample + 1u))));
}

#endif
