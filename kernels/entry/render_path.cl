// One stage: the path-traced image of a rectangle of pixels, by unidirectional paths (Kajiya 1986, "The
// Rendering Equation"). A work-item takes TILE_W x TILE_H pixels, a pixel a lane; a lane whose path has ended
// takes its pixel's next sample, so lanes are seldom idle, and a pixel's samples stay in their order.
// Shadow rays see what paths that meet lights by chance would.
#define SHADOWS_AS_PATHS 1
#include "lib/core/counters.cl"
#include "lib/core/filter.cl"
#include "lib/core/sampler.cl"
#include "lib/path/lens.cl"
#include "lib/path/tile.cl"
#include "lib/pathtracer/steps.cl"
#include "shared/launch.h"

// What a work-item's lanes are at.
typedef struct LaneWork {
  u32 next[BATCH];    // sample that the lane takes next
  float sign[BATCH];  // what the sample counts that it is at
} LaneWork;

// The lanes of `idle` whose pixels have samples left begin with them. Returns those lanes.
NEVER_INLINE MASK begin_samples(const Scene* scene, const Launch* launch, __global const u32* restrict pixels,
                                u32 item, MediaStack around, MASK idle, LaneWork* work, Walks* walks,
                                SceneRays* rays) {
  __global const SceneInfo* restrict info = scene->info;
  const u32 last = launch->first_sample + launch->sample_count;
  MASK begun = NO_LANES;
  REAL x = (REAL)(0.0f), y = (REAL)(0.0f);
  LaneSamples at = {NO_LANES, NO_LANES, NO_LANES};
  CameraSamples samples = {.sample = 0u};
  for (u32 bits = lane_bits(idle); bits; bits &= bits - 1u) {
    const u32 lane = lowest_bit(bits);
    uint2 pixel;
    if (work->next[lane] >= last) continue;
    if (!image_pixel(launch, pixels, lane_pixel(launch, item, lane), &pixel)) continue;
    const u32 sample = work->next[lane]++;
    float2 in_pixel = pixel_sample(pixel, sample, info->samples);
    work->sign[lane] = filter_place(scene->filter, info->samples, &in_pixel);
    REAL_LANE(x, lane) = (float)pixel.x + in_pixel.x;
    REAL_LANE(y, lane) = (float)pixel.y + in_pixel.y;
    MASK_LANE(begun, lane) = -1;
    MASK_LANE(at.x, lane) = (int)pixel.x;
    MASK_LANE(at.y, lane) = (int)pixel.y;
    MASK_LANE(at.sample, lane) = (int)sample;
    samples.sample = sample;
    set_camera_sample(&samples, lane, pixel);
  }
  if (!any_lane(begun)) return begun;
  const Rays camera = sampled_camera_rays(info, x, y, &samples);
  const SceneRays first = scene_rays(&camera, around);
  const Walks fresh = start_walks(scene, &at, begun);
  join_rays(rays, &first, begun);
  join_walks(walks, &fresh, begun);
  return begun;
}

// One work-item of the kernel below.
NEVER_INLINE void render_item(const Scene* scene, MediaStack around, const Launch* launch, u32 item,
                              __global const u32* restrict pixels, __global float4* restrict film,
                              __global float* restrict weights, __global u32* restrict counters) {
  u32 counts[COUNTERS];
  for (u32 i = 0; i < COUNTERS; ++i) counts[i] = 0;
  LaneWork work;
  for (u32 lane = 0; lane < BATCH; ++lane) work.next[lane] = launch->first_sample;
  const LaneSamples nowhere = {NO_LANES, NO_LANES, NO_LANES};
  const Rays none = camera_rays(scene->info, (REAL)(0.0f), (REAL)(0.0f));
  Walks walks = start_walks(scene, &nowhere, NO_LANES);
  SceneRays rays = scene_rays(&none, around);
  MASK lanes = NO_LANES;
  for (;;) {
    const MASK begun = begin_samples(scene, launch, pixels, item, around, ~lanes, &work, &walks, &rays);
    const MASK going = lanes | begun;
    if (!any_lane(going)) break;
    counts[COUNT_PRIMARY] += lane_count(begun);
    start_marching(counts);
    lanes = step_walks(scene, &walks, &rays, going, !any_lane(lanes), counts);
    const MASK over = going & ~lanes;
    if (!any_lane(over)) continue;
    const REAL3 seen = carry_seen(scene, &walks.wavelengths, &walks.light, over);
    for (u32 bits = lane_bits(over); bits; bits &= bits - 1u) {
      const u32 lane = lowest_bit(bits);
      const float4 radiance = (float4)(get3(&seen, lane), MASK_LANE(walks.met, lane) ? 1.0f : 0.0f);
      store_lane(launch, item, lane, radiance, work.sign[lane], film, weights, counts);
    }
  }
  counts[COUNT_MARCH_LEFT] = 0u;
  add_counts(counters, counts);
  add_finished(counters, counts[COUNT_PRIMARY], launch->sample_count);
}

// Reads the scene; adds samples [first_sample, first_sample + sample_count) of the pixels of work-items
// [first_item, last_item) of the rectangle (x0, y0, width, height), or of the image's pixels that it stands
// for (`pixels`, where the launch is of a list), to film (rgb and coverage) and their number to weights, as
// render_whitted does; adds to counters.
__kernel void render_path(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                          __global const u32* restrict pixels, __global float4* restrict film,
                          __global float* restrict weights, __global u32* restrict counters,
                          const Launch launch) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 item = launch.first_item + get_global_id(1) * launch.row_items + get_global_id(0);
  if (get_global_id(0) >= launch.row_items || item >= launch.last_item) return;
  render_item(&scene, (MediaStack)camera_media[1] << 32 | camera_media[0], &launch, item, pixels, film,
              weights, counters);
}
