// One stage: the Whitted image of a rectangle of pixels. A work-item takes TILE_W x TILE_H pixels, whose
// place in the image is a multiple of the tile, so that the pixels it works on together are the same however
// the frame is cut.
#include "lib/core/counters.cl"
#include "lib/path/ray_counts.cl"
#include "lib/whitted/whitted_batch.cl"
#include "lib/whitted/whitted_single.cl"
#include "plain/path/lens.cl"
#include "shared/launch.h"

// The camera's rays of one sample. Returns the lanes that have a pixel; signs[lane] is what a sample counts.
static inline MASK start_rays(const Scene* scene, const Launch* launch, __global const u32* restrict pixels,
                              u32 item, u32 sample, MediaStack around, SceneRays* rays, float* signs,
                              TileSamples* tile) {
  LaneSamples at;
  REAL sign;
  tile->sample = sample;
  const MASK begun = item_pixels(launch, pixels, item, &at.x, &at.y);
  at.sample = (MASK)((int)sample) & begun;
  at.seed = scene->info->seed;
  set_tile_pixels(tile, &at);
  *rays = sample_ray(scene, &at, scene->info->samples, &around, &sign, begun);
  EACH_LANE(lane, begun) signs[lane] = REAL_LANE(sign, lane);
  return begun;
}

// Where the tile's surfaces note what they cover of their pixels, of which each sample counts signs[lane].
#if HAS_MATTES
static inline void set_tile_sums(const Launch* launch, u32 item, const float* signs,
                                 __global float4* restrict film, TileSamples* tile) {
  tile->sums = sample_sums(launch, film, 0u);
  for (u32 lane = 0; lane < BATCH; ++lane) {
    const uint2 at = lane_pixel(launch, item, lane);
    MASK_LANE(tile->place, lane) = (int)(at.y * launch->width + at.x);
    REAL_LANE(tile->sign, lane) = signs[lane];
  }
}
#endif

// A work-item keeps this while it traces.
typedef struct ItemWork {
  float4 radiance[BATCH];
  float signs[BATCH];
  u32 item;
  __global const SceneInfo* info;  // read here for each sample, or compilers keep the camera in registers
  u32 counts[ALL_COUNTS];
} ItemWork;

// One work-item of the kernel below.
NEVER_INLINE void render_item(const Scene* scene, MediaStack around, const Launch* launch, u32 item,
                              __global const u32* restrict pixels, __global float4* restrict film,
                              __global float* restrict weights, __global u32* restrict counters,
                              __global u32* restrict ray_counts) {
  KEEP_IN_MEMORY(ItemWork, work);
  work->item = item;
  work->info = scene->info;
  u32* counts = work->counts;
  for (u32 i = 0; i < ALL_COUNTS; ++i) counts[i] = 0;
  begin_film(launch, item, film, weights, ray_counts);
  for (u32 sample = launch->first_sample; sample < launch->first_sample + launch->sample_count; ++sample) {
    for (u32 lane = 0; lane < BATCH; ++lane) work->radiance[lane] = (float4)(0.0f, 0.0f, 0.0f, 1.0f);
    start_marching(counts);
    SceneRays rays;
    Scene read = *scene;
    read.info = work->info;
    TileSamples tile;
    tile.radiance = work->radiance;
    const MASK lanes =
        start_rays(&read, launch, pixels, work->item, sample, around, &rays, work->signs, &tile);
    HAVING(HAS_MATTES, set_tile_sums(launch, work->item, work->signs, film, &tile);)
    counts[COUNT_PRIMARY] += lane_count(lanes);
    note_own_rays(lanes, counts);
    trace_whitted(scene, &tile, &rays, lanes, counts);
    for (u32 lane = 0; lane < BATCH; ++lane)
      work->radiance[lane] = limit_components(work->radiance[lane], scene->info->max_component);
    store_lanes(launch, work->item, lanes, work->radiance, work->signs, film, weights, counts);
  }
  add_ray_counts(launch, pixels, work->item, counts, ray_counts);
  add_counts(counters, counts);
  add_finished(counters, counts[COUNT_PRIMARY], launch->sample_count);
}

// Reads the scene; adds samples [first_sample, first_sample + sample_count) of the pixels of work-items
// [first_item, last_item) of the rectangle (x0, y0, width, height), or of the image's pixels that it stands
// for (`pixels`, where the launch is of a list), to film (rgb and coverage) and their
// number to weights (a sample that is not finite counts for nothing, one in a filter's lobe below zero -1);
// adds to counters, and where they are asked for the rays of pixels to ray_counts (lib/path/ray_counts.cl).
// Where first_sample is 0, film, weights and ray_counts may hold anything before.
__kernel FOR_WAVES(0) void render_whitted(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                                          __global const u32* restrict pixels, __global float4* restrict film,
                                          __global float* restrict weights, __global u32* restrict counters,
                                          __global u32* restrict ray_counts, const Launch launch) {
  const Scene scene = SCENE_OF_PARAMETERS;
  // Items count through the rectangle row by row; a launch in two dimensions takes whole rows of them.
  const u32 item = launch.first_item + get_global_id(1) * launch.row_items + get_global_id(0);
  if (get_global_id(0) >= launch.row_items || item >= launch.last_item) return;
  render_item(&scene, read_media(camera_media), &launch, item, pixels, film, weights,
              counters_of(counters, item), ray_counts);
}
