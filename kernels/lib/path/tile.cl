// The pixels of a work-item's lanes, and storage of their samples.
#pragma once
#include "lib/core/lanes.h"
#include "lib/path/mattes.cl"
#include "shared/launch.h"
#include "shared/scene.h"

// Pixel of lane `lane` of work-item `item`, relative to the rectangle's corner. Neighbouring work-items have
// neighbouring tiles. Those of one pixel are ordered in blocks of 8x4, each in quarters of 4x2, so that the
// eight or thirty-two that a device runs together have similar ray trees; in a two-dimensional launch the
// group has its own shape.
static inline uint2 lane_pixel(const Launch* launch, u32 item, u32 lane) {
  if (BATCH == 1 && launch->blocks) {
    const u32 columns = (launch->width + 7u) / 8u, block = item / 32u;
    return (uint2)(block % columns * 8u + (item >> 1 & 4u) + (item & 3u),
                   block / columns * 4u + (item >> 3 & 2u) + (item >> 2 & 1u));
  }
  const u32 columns = (launch->width + TILE_W - 1u) / TILE_W;
  return (uint2)(item % columns * TILE_W + lane % TILE_W, item / columns * TILE_H + lane / TILE_W);
}

// Whether the item's tile is completely inside the rectangle, at `corner`.
static inline bool is_whole_tile(const Launch* launch, u32 item, uint2* corner) {
  *corner = lane_pixel(launch, item, 0u);
  return corner->x + TILE_W <= launch->width && corner->y + TILE_H <= launch->height;
}

// Index of lane `lane` of a whole tile in the rectangle's arrays.
static inline u32 pixel_of_tile(const Launch* launch, uint2 corner, u32 lane) {
  return (corner.y + lane / TILE_W) * launch->width + corner.x + lane % TILE_W;
}

// The image pixel that pixel `at` of the rectangle stands for. False: none.
static inline bool image_pixel(const Launch* launch, __global const u32* restrict pixels, uint2 at,
                               uint2* pixel) {
  *pixel = (uint2)(launch->x0, launch->y0) + at;
  if (at.x >= launch->width || at.y >= launch->height) return false;
  if (!launch->listed) return true;
  const u32 listed = pixels[at.y * launch->width + at.x];
  *pixel = (uint2)(listed & 0xffffu, listed >> 16);
  return listed != NO_PIXEL;
}

// The image pixels of a work-item's lanes. Returns the lanes that have one.
static inline MASK item_pixels(const Launch* launch, __global const u32* restrict pixels, u32 item, MASK* x,
                               MASK* y) {
  uint2 corner;
  if (is_whole_tile(launch, item, &corner)) {
    if (!launch->listed) {
      *x = (int)(launch->x0 + corner.x) + LANE_NUMBERS % TILE_W;
      *y = (int)(launch->y0 + corner.y) + LANE_NUMBERS / TILE_W;
      return ALL_LANES;
    }
    MASK listed;
#pragma unroll
    for (u32 lane = 0; lane < BATCH; ++lane)
      MASK_LANE(listed, lane) = (int)pixels[pixel_of_tile(launch, corner, lane)];
    const MASK lanes = MASK_OF(listed != (int)NO_PIXEL);
    *x = listed & 0xffff & lanes;
    *y = (listed >> 16) & 0xffff & lanes;
    return lanes;
  }
  MASK lanes = NO_LANES;
  *x = *y = NO_LANES;
  for (u32 lane = 0; lane < BATCH; ++lane) {
    uint2 pixel;
    if (!image_pixel(launch, pixels, lane_pixel(launch, item, lane), &pixel)) continue;
    MASK_LANE(*x, lane) = (int)pixel.x;
    MASK_LANE(*y, lane) = (int)pixel.y;
    MASK_LANE(lanes, lane) = -1;
  }
  return lanes;
}

// Clears film, weights and rays of the work-item's pixels if the launch makes their first
// samples.
static inline void begin_film(const Launch* launch, u32 item, __global float4* restrict film,
                              __global float* restrict weights, __global u32* restrict rays) {
  if (launch->first_sample > 0u) return;
  uint2 corner;
  if (is_whole_tile(launch, item, &corner)) {
#pragma unroll
    for (u32 lane = 0; lane < BATCH; ++lane) {
      const u32 pixel = pixel_of_tile(launch, corner, lane);
      film[pixel] = (float4)(0.0f);
      weights[pixel] = 0.0f;
      clear_sample_sums(launch, film, pixel);
      rays[pixel] = 0u;
    }
    return;
  }
  for (u32 lane = 0; lane < BATCH; ++lane) {
    const uint2 at = lane_pixel(launch, item, lane);
    if (at.x >= launch->width || at.y >= launch->height) continue;
    const u32 pixel = at.y * launch->width + at.x;
    film[pixel] = (float4)(0.0f);
    weights[pixel] = 0.0f;
    clear_sample_sums(launch, film, pixel);
    rays[pixel] = 0u;
  }
}

// The share of a sample's radiance whose greatest component is at most `most`.
static inline float limiting_share(float3 radiance, float most) {
  const float greatest = fmax(fmax(radiance.x, radiance.y), radiance.z);
  return greatest > most ? most / greatest : 1.0f;
}
static inline float4 limit_components(float4 radiance, float most) {
  const float share = limiting_share(radiance.xyz, most);
  return share < 1.0f ? (float4)(radiance.xyz * share, radiance.w) : radiance;
}

static inline bool all_finite(float3 radiance) {
  const float3 zero = radiance * 0.0f;  // NaN if one is not finite
  return zero.x + zero.y + zero.z == 0.0f;
}

// Adds a sample's light to film and weights of the rectangle's pixel `place`, with the weight `sign`.
static inline void store_sample(u32 place, float4 radiance, float sign, __global float4* restrict film,
                                __global float* restrict weights, u32* counts) {
  if (!all_finite(radiance.xyz)) {
    counts[COUNT_NON_FINITE] += 1u;
    return;
  }
  film[place] += HAS_FILTER ? sign * radiance : radiance;
  weights[place] += HAS_FILTER ? sign : 1.0f;
}

// store_sample() for the pixels of all lanes of `lanes`; arrays by lane.
static inline void store_lanes(const Launch* launch, u32 item, MASK lanes, const float4* radiance,
                               const float* signs, __global float4* restrict film,
                               __global float* restrict weights, u32* counts) {
  float4 zero = (float4)(0.0f);  // NaN where one is not finite
#pragma unroll
  for (u32 lane = 0; lane < BATCH; ++lane) zero += radiance[lane] * 0.0f;
  uint2 corner;
  if (HAS_FILTER || zero.x + zero.y + zero.z != 0.0f || !is_whole_tile(launch, item, &corner)) {
    EACH_LANE(lane, lanes) {
      const uint2 at = lane_pixel(launch, item, lane);
      store_sample(at.y * launch->width + at.x, radiance[lane], signs[lane], film, weights, counts);
    }
    return;
  }
  const REAL share = TO_REAL(-lanes);
#pragma unroll
  for (u32 lane = 0; lane < BATCH; ++lane) {
    const u32 pixel = pixel_of_tile(launch, corner, lane);
    film[pixel] += radiance[lane];
    weights[pixel] += REAL_LANE(share, lane);
  }
}
