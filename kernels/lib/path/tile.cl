// The pixels of a work-item's lanes, and where their samples go.
#ifndef SUNDOG_LIB_TILE_CL
#define SUNDOG_LIB_TILE_CL
#include "lib/core/config.h"
#include "shared/launch.h"
#include "shared/scene.h"

// Pixel of lane `lane` of work-item `item`, counted from the rectangle's corner. Neighbouring work-items take
// neighbouring tiles. Those of one pixel go through blocks of 8x4 of them, each in quarters of 4x2, so that
// the eight or thirty-two that a device runs together have ray trees that are alike; in a launch of two
// dimensions the group has its own shape.
static inline uint2 lane_pixel(const Launch* launch, u32 item, u32 lane) {
  if (BATCH == 1 && launch->blocks) {
    const u32 columns = (launch->width + 7u) / 8u, block = item / 32u;
    return (uint2)(block % columns * 8u + (item >> 1 & 4u) + (item & 3u),
                   block / columns * 4u + (item >> 3 & 2u) + (item >> 2 & 1u));
  }
  const u32 columns = (launch->width + TILE_W - 1u) / TILE_W;
  return (uint2)(item % columns * TILE_W + lane % TILE_W, item / columns * TILE_H + lane / TILE_W);
}

// The pixel of the image that the pixel `at` of the rectangle stands for. False: there is none.
static inline bool image_pixel(const Launch* launch, __global const u32* restrict pixels, uint2 at,
                               uint2* pixel) {
  if (at.x >= launch->width || at.y >= launch->height) return false;
  *pixel = (uint2)(launch->x0, launch->y0) + at;
  if (!launch->listed) return true;
  const u32 listed = pixels[at.y * launch->width + at.x];
  *pixel = (uint2)(listed & 0xffffu, listed >> 16);
  return listed != NO_PIXEL;
}

// Clears film, weights and, where they are asked for, rays of the work-item's pixels, if the launch makes
// their first samples.
static inline void begin_film(const Launch* launch, u32 item, __global float4* restrict film,
                              __global float* restrict weights, __global u32* restrict rays) {
  if (launch->first_sample > 0u) return;
  for (u32 lane = 0; lane < BATCH; ++lane) {
    const uint2 at = lane_pixel(launch, item, lane);
    if (at.x >= launch->width || at.y >= launch->height) continue;
    const u32 pixel = at.y * launch->width + at.x;
    film[pixel] = (float4)(0.0f);
    weights[pixel] = 0.0f;
    if (launch->counts_rays) rays[pixel] = 0u;
  }
}

// Adds the light of a sample to film and weights, of the pixel that lane `lane` stands for; `sign` is what
// the sample counts.
static inline void store_lane(const Launch* launch, u32 item, u32 lane, float4 radiance, float sign,
                              __global float4* restrict film, __global float* restrict weights, u32* counts) {
  const float3 zero = radiance.xyz * 0.0f;  // NaN where one is not finite
  if (zero.x + zero.y + zero.z != 0.0f) {
    counts[COUNT_NON_FINITE] += 1u;
    return;
  }
  const uint2 at = lane_pixel(launch, item, lane);
  const u32 pixel = at.y * launch->width + at.x;
  film[pixel] += HAS_FILTER ? sign * radiance : radiance;
  weights[pixel] += HAS_FILTER ? sign : 1.0f;
}

#endif
