// One stage: the Whitted image of a rectangle of pixels. A work-item takes TILE_W x TILE_H pixels, whose
// place in the image is a multiple of the tile, so that the pixels it works on together are the same however
// the frame is cut.
#include "lib/counters.cl"
#include "lib/random.cl"
#include "lib/whitted.cl"

#define NO_PIXEL 0xFFFFFFFFu

// Pixel of this work-item's lane in the rectangle, NO_PIXEL outside of it. Neighbouring work-items take
// neighbouring tiles.
static inline u32 lane_pixel(u32 item, u32 lane, u32 x0, u32 y0, u32 width, u32 height, u32* x, u32* y) {
  const u32 columns = (width + TILE_W - 1u) / TILE_W;
  const u32 local_x = (item % columns) * TILE_W + lane % TILE_W,
            local_y = (item / columns) * TILE_H + lane / TILE_W;
  *x = x0 + local_x;
  *y = y0 + local_y;
  return local_x < width && local_y < height ? local_y * width + local_x : NO_PIXEL;
}

// One work-item of the kernel below.
NEVER_INLINE void render_item(TRACE_PARAMETERS, SHADE_PARAMETERS, __global const u32* restrict camera_media,
                              __global float4* restrict film, __global float* restrict weights,
                              __global u32* restrict counters, u32 item, u32 x0, u32 y0, u32 width,
                              u32 height, u32 first_sample, u32 sample_count) {
  u32 counts[COUNTERS];
  for (u32 i = 0; i < COUNTERS; ++i) counts[i] = 0;
  const MediaStack start = (MediaStack)camera_media[1] << 32 | camera_media[0];
  RayStack stack;
  for (u32 sample = first_sample; sample < first_sample + sample_count; ++sample) {
    float4 radiance[BATCH];
    stack.count = 0;
#if HAS_SDF
    counts[COUNT_MARCH_LEFT] = MARCH_WORK;
#endif
    for (u32 lane = 0; lane < BATCH; ++lane) {
      u32 x, y;
      radiance[lane] = (float4)(0.0f);
      if (lane_pixel(item, lane, x0, y0, width, height, &x, &y) == NO_PIXEL) continue;
      const float2 at = sample_offset(x, y, sample, info->samples);
      const CameraRay camera = camera_ray(info, (float)x + at.x, (float)y + at.y);
      stack.rays[stack.count] = scene_ray(&camera, start);
      PathState* path = &stack.paths[stack.count++];
      path->throughput = (float3)(1.0f);
      path->pixel = lane;
      path->depth = 1u;
      counts[COUNT_PRIMARY] += 1u;
    }
    trace_whitted(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &stack, radiance, counts);
    for (u32 lane = 0; lane < BATCH; ++lane) {
      u32 x, y;
      const u32 pixel = lane_pixel(item, lane, x0, y0, width, height, &x, &y);
      if (pixel == NO_PIXEL) continue;
      if (!finite3(radiance[lane].xyz)) {
        counts[COUNT_NON_FINITE] += 1u;
        continue;
      }
      film[pixel] += radiance[lane];
      weights[pixel] += 1.0f;
    }
  }
  counts[COUNT_MARCH_LEFT] = 0u;
  add_counts(counters, counts);
  add_finished(counters, counts[COUNT_PRIMARY], sample_count);
}

// Reads the scene; adds samples [first_sample, first_sample + sample_count) of the pixels of work-items
// [first_item, last_item) of the rectangle (x0, y0, width, height) to film (rgb and coverage) and their
// number to weights (a sample that is not finite counts for nothing); adds to counters.
__kernel void render_whitted(TRACE_PARAMETERS, SHADE_PARAMETERS, __global const u32* restrict camera_media,
                             __global float4* restrict film, __global float* restrict weights,
                             __global u32* restrict counters, u32 x0, u32 y0, u32 width, u32 height,
                             u32 row_items, u32 first_item, u32 last_item, u32 first_sample,
                             u32 sample_count) {
  // Items count through the rectangle row by row; a launch in two dimensions takes whole rows of them.
  const u32 item = first_item + get_global_id(1) * row_items + get_global_id(0);
  if (get_global_id(0) >= row_items || item >= last_item) return;
  render_item(TRACE_ARGUMENTS, SHADE_ARGUMENTS, camera_media, film, weights, counters, item, x0, y0, width,
              height, first_sample, sample_count);
}
