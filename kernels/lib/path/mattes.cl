// Which objects and materials cover a pixel, each with the sum of what it covers of the pixel's samples. A
// surface covers the part of the light from behind the scene that goes no further straight on, so that the
// shares of a pixel sum to its alpha.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"
#include "shared/launch.h"
#include "shared/light_parts.h"

// Sums of a pixel's samples: mattes, then parts of light.
#define FIRST_LIGHT_VECTOR (HAS_MATTES ? MATTE_VECTORS : 0u)
#define SAMPLE_VECTORS (FIRST_LIGHT_VECTOR + (HAS_LIGHT_SUMS ? LIGHT_VECTORS : 0u))

// The sums of the rectangle's pixel `place`. They lie behind the film of all its pixels.
static inline __global float4* sample_sums(const Launch* launch, __global float4* film, u32 place) {
  return film + launch->width * launch->height + place * SAMPLE_VECTORS;
}

static inline void clear_sample_sums(const Launch* launch, __global float4* film, u32 place) {
  for (u32 k = 0; k < SAMPLE_VECTORS; ++k) sample_sums(launch, film, place)[k] = (float4)(0.0f);
}

#if HAS_MATTES
// Adds to the share of `id`. Where all ranks are taken it takes over the smallest: the sum of all stays right
// (Metwally and others 2005, "Efficient Computation of Frequent and Top-k Elements in Data Streams").
static inline void add_share(__global float* pairs, u32 id, float share) {
  const float name = (float)(id + 1u);
  u32 at = 0;
  float least = INFINITY;
  for (u32 k = 0; k < MATTE_RANKS; ++k) {
    const float there = pairs[2u * k], much = pairs[2u * k + 1u];
    if (there == name || there == 0.0f) {
      at = k;
      break;
    }
    if (much < least) {
      least = much;
      at = k;
    }
  }
  pairs[2u * at] = name;
  pairs[2u * at + 1u] += share;
}

// A surface of that instance and material covers `share` of a sample.
static inline void add_matte(const Scene* scene, __global float4* sums, int instance, int material,
                             float share) {
  add_share((__global float*)sums, scene->instances[instance].object, share);
  add_share((__global float*)sums + 2u * MATTE_RANKS, (u32)material, share);
}
#endif
