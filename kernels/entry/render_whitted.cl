// One stage: the Whitted image of a rectangle of pixels. A work-item takes TILE_W x TILE_H pixels, whose
// place in the image is a multiple of the tile, so that the pixels it works on together are the same however
// the frame is cut.
#include "lib/core/counters.cl"
#include "lib/core/filter.cl"
#include "lib/core/sampler.cl"
#include "lib/path/lens.cl"
#include "lib/whitted/whitted.cl"
#include "shared/launch.h"

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

// The camera's rays of one sample. Returns the lanes that have a pixel; signs[lane] is what a sample counts.
static inline MASK start_rays(const Scene* scene, const Launch* launch, __global const u32* restrict pixels,
                              u32 item, u32 sample, MediaStack around, SceneRays* rays, float* signs,
                              TileSamples* tile) {
  __global const SceneInfo* restrict info = scene->info;
  MASK lanes = NO_LANES;
  tile->sample = sample;
  REAL x = (REAL)(0.0f), y = (REAL)(0.0f);
  CameraSamples samples = {.sample = sample};
  for (u32 lane = 0; lane < BATCH; ++lane) {
    uint2 pixel;
    if (!image_pixel(launch, pixels, lane_pixel(launch, item, lane), &pixel)) continue;
    float2 in_pixel = pixel_sample(pixel, sample, info->samples);
    signs[lane] = filter_place(scene->filter, info->samples, &in_pixel);
    REAL_LANE(x, lane) = (float)pixel.x + in_pixel.x;
    REAL_LANE(y, lane) = (float)pixel.y + in_pixel.y;
    MASK_LANE(lanes, lane) = -1;
    set_tile_pixel(tile, lane, pixel);
    set_camera_sample(&samples, lane, pixel);
  }
  const Rays camera = sampled_camera_rays(info, x, y, &samples);
  *rays = scene_rays(&camera, around);
  return lanes;
}

// Adds the light of one sample to film and weights.
static inline void store_sample(const Launch* launch, u32 item, MASK lanes, const float4* radiance,
                                const float* signs, __global float4* restrict film,
                                __global float* restrict weights, u32* counts) {
  for (u32 lane = 0; lane < BATCH; ++lane) {
    if (!MASK_LANE(lanes, lane)) continue;
    const float3 zero = radiance[lane].xyz * 0.0f;  // NaN where one is not finite
    if (zero.x + zero.y + zero.z != 0.0f) {
      counts[COUNT_NON_FINITE] += 1u;
      continue;
    }
    const uint2 at = lane_pixel(launch, item, lane);
    const u32 pixel = at.y * launch->width + at.x;
    film[pixel] += HAS_FILTER ? signs[lane] * radiance[lane] : radiance[lane];
    weights[pixel] += HAS_FILTER ? signs[lane] : 1.0f;
  }
}

// One work-item of the kernel below.
NEVER_INLINE void render_item(const Scene* scene, MediaStack around, const Launch* launch, u32 item,
                              __global const u32* restrict pixels, __global float4* restrict film,
                              __global float* restrict weights, __global u32* restrict counters) {
  u32 counts[COUNTERS];
  for (u32 i = 0; i < COUNTERS; ++i) counts[i] = 0;
  RayStack stack;
  for (u32 sample = launch->first_sample; sample < launch->first_sample + launch->sample_count; ++sample) {
    float4 radiance[BATCH];
    for (u32 lane = 0; lane < BATCH; ++lane) radiance[lane] = (float4)(0.0f);
    start_marching(counts);
    SceneRays rays;
    float signs[BATCH];
    TileSamples tile;
    const MASK lanes = start_rays(scene, launch, pixels, item, sample, around, &rays, signs, &tile);
    counts[COUNT_PRIMARY] += lane_count(lanes);
    trace_whitted(scene, &tile, &rays, lanes, &stack, radiance, counts);
    store_sample(launch, item, lanes, radiance, signs, film, weights, counts);
  }
  counts[COUNT_MARCH_LEFT] = 0u;
  add_counts(counters, counts);
  add_finished(counters, counts[COUNT_PRIMARY], launch->sample_count);
}

// Reads the scene; adds samples [first_sample, first_sample + sample_count) of the pixels of work-items
// [first_item, last_item) of the rectangle (x0, y0, width, height), or of the image's pixels that it stands
// for (`pixels`, where the launch is of a list), to film (rgb and coverage) and their
// number to weights (a sample that is not finite counts for nothing, one in a filter's lobe below zero -1);
// adds to counters.
__kernel void render_whitted(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                             __global const u32* restrict pixels, __global float4* restrict film,
                             __global float* restrict weights, __global u32* restrict counters,
                             const Launch launch) {
  const Scene scene = SCENE_OF_PARAMETERS;
  // Items count through the rectangle row by row; a launch in two dimensions takes whole rows of them.
  const u32 item = launch.first_item + get_global_id(1) * launch.row_items + get_global_id(0);
  if (get_global_id(0) >= launch.row_items || item >= launch.last_item) return;
  render_item(&scene, (MediaStack)camera_media[1] << 32 | camera_media[0], &launch, item, pixels, film,
              weights, counters);
}
