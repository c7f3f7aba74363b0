// The pixels of a work-item, for integrators that finish a sample of all its pixels before the next: camera
// rays, the light that they bring, film. An integrator includes this after its follow_camera_rays().
#include "lib/core/counters.cl"
#include "lib/path/fields.cl"
#include "lib/path/path_samples.cl"
#include "lib/path/ray_counts.cl"
#include "plain/path/lens.cl"
#include "shared/launch.h"

// Follows the camera's rays of `lanes`, pixel i in lane i, and adds what they see to tile->radiance[i]: rgb and
// coverage, at first (0, 0, 0, 1).
void follow_camera_rays(const Scene* scene, TileSamples* tile, SceneRays* rays, MASK lanes, u32* counts);

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

// Adds the samples of a work-item's pixels to the film, and its rays to the counters.
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
    follow_camera_rays(scene, &tile, &rays, lanes, counts);
    for (u32 lane = 0; lane < BATCH; ++lane)
      work->radiance[lane] = limit_components(work->radiance[lane], scene->info->max_component);
    store_lanes(launch, work->item, lanes, work->radiance, work->signs, film, weights, counts);
  }
  add_ray_counts(launch, pixels, work->item, counts, ray_counts);
  add_counts(counters, counts);
  add_finished(counters, counts[COUNT_PRIMARY], launch->sample_count);
}
