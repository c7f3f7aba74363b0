// Sample values: pure functions of pixel, sample and dimension.
#ifndef SUNDOG_LIB_SAMPLER_CL
#define SUNDOG_LIB_SAMPLER_CL
#include "shared/types.h"

// PCG's output permutation on a counter (O'Neill 2014; Jarzynski and Olano 2020).
static inline u32 hash_u32(u32 x) {
  const u32 state = x * 747796405u + 2891336453u;
  const u32 word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

static inline u32 hash_pixel(u32 x, u32 y, u32 dimension) {
  return hash_u32(x + hash_u32(y + hash_u32(dimension)));
}

// [0, 1), 24 bits.
static inline float unit_float(u32 bits) { return (float)(bits >> 8) * 0x1p-24f; }

// A number in [0, 1) for a dimension of a pixel's sample.
static inline float sample_1d(uint2 pixel, u32 sample, u32 dimension) {
  return unit_float(hash_u32(sample + hash_pixel(pixel.x, pixel.y, dimension)));
}

// Two numbers in [0, 1) for the dimensions `dimension` and `dimension` + 1.
static inline float2 sample_2d(uint2 pixel, u32 sample, u32 dimension) {
  return (float2)(sample_1d(pixel, sample, dimension), sample_1d(pixel, sample, dimension + 1u));
}

// Offset of a camera sample in its pixel: the centre for one sample, else a Hammersley set shifted per pixel
// (Cranley and Patterson 1976).
static inline float2 pixel_sample(uint2 pixel, u32 sample, u32 samples) {
  if (samples <= 1u) return (float2)(0.5f);
  u32 r = sample;  // radical inverse in base two
  r = (r << 16) | (r >> 16);
  r = ((r & 0x00ff00ffu) << 8) | ((r & 0xff00ff00u) >> 8);
  r = ((r & 0x0f0f0f0fu) << 4) | ((r & 0xf0f0f0f0u) >> 4);
  r = ((r & 0x33333333u) << 2) | ((r & 0xccccccccu) >> 2);
  r = ((r & 0x55555555u) << 1) | ((r & 0xaaaaaaaau) >> 1);
  const float a = ((float)sample + 0.5f) / (float)samples + unit_float(hash_pixel(pixel.x, pixel.y, 0u));
  const float b = unit_float(r + hash_pixel(pixel.x, pixel.y, 1u));
  return (float2)(fmin(a - floor(a), 0x1.fffffep-1f), b);
}

#endif
