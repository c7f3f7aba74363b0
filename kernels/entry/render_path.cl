// One stage: the path-traced image of a rectangle of pixels, by unidirectional paths (Kajiya 1986, "The
// Rendering Equation"). A work-item makes TILE_W x TILE_H pixels of several items, a path a lane. A lane
// whose path has ended takes its pixel's next sample, then the first pixel that no lane has taken: lanes are
// seldom idle, and a pixel's samples stay in their order. Shadow rays see what paths that meet lights by
// chance would.
#define SHADOWS_AS_PATHS 1
#define RAYS_BY_LANE 1
#include "lib/core/counters.cl"
#include "lib/light/choose_light.cl"
#include "lib/light/relief_shadow.cl"
#include "lib/path/camera_samples.cl"
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/steps.cl"
#include "plain/pathtracer/bounce.cl"
#include "shared/launch.h"

#define NO_PLACE (-1)

// What a work-item's lanes are at. All zero is a work-item that has ended: Mesa's llvmpipe (22.3) runs groups
// in whole vectors, and where a group does not fill one, the others loop by the zeros that they read here.
typedef struct LaneWork {
  u32 untaken, end;   // pixels that no lane has taken yet: BATCH an item
  LaneSamples at;     // the lanes' pixels of the image, and the samples that they take next
  MASK left;          // the samples that their pixels still get
  MASK place;         // the same pixels in the rectangle, or NO_PLACE
  float sign[BATCH];  // what the sample counts that the lane is at
} LaneWork;

static inline LaneWork begin_work(const Scene* scene, u32 first, u32 end) {
  LaneWork work;
  work.untaken = first * BATCH;
  work.end = end * BATCH;
  work.at.x = work.at.y = work.at.sample = work.left = NO_LANES;
  work.at.seed = scene->info->seed;
  work.place = (MASK)(NO_PLACE);
  return work;
}

// The lane is done with its pixel and takes the next that no lane has, if there is one.
static inline void take_pixel(const Launch* launch, __global const u32* restrict pixels, u32 lane,
                              LaneWork* work, u32* counts, __global u32* restrict ray_counts) {
  const int done = MASK_LANE(work->place, lane);
  if (done != NO_PLACE) add_lane_rays(launch, (u32)done, lane, counts, ray_counts);
  MASK_LANE(work->place, lane) = NO_PLACE;
  while (work->untaken < work->end) {
    const u32 taken = work->untaken++;
    const uint2 at = lane_pixel(launch, taken / BATCH, taken % BATCH);
    uint2 pixel;
    if (!image_pixel(launch, pixels, at, &pixel)) continue;
    MASK_LANE(work->at.x, lane) = (int)pixel.x;
    MASK_LANE(work->at.y, lane) = (int)pixel.y;
    MASK_LANE(work->at.sample, lane) = (int)launch->first_sample;
    MASK_LANE(work->left, lane) = (int)launch->sample_count;
    MASK_LANE(work->place, lane) = (int)(at.y * launch->width + at.x);
    return;
  }
}

// The lanes of `idle` that have samples left begin with them. Returns those lanes.
NEVER_INLINE MASK fill_idle_lanes(const Scene* scene, const Launch* launch,
                                  __global const u32* restrict pixels, MediaStack around, MASK idle,
                                  LaneWork* work, PathStates* paths, SceneRays* rays, u32* counts,
                                  __global u32* restrict ray_counts) {
  EACH_LANE(lane, idle & MASK_OF(work->left == 0)) take_pixel(launch, pixels, lane, work, counts, ray_counts);
  const BegunSamples begun = {work->at, idle & MASK_OF(work->left != 0)};
  if (!any_lane(begun.lanes)) return NO_LANES;
  work->at.sample -= begun.lanes;
  work->left += begun.lanes;
  const SceneRays first = begun_rays(scene, &begun, scene->info->samples, around, work->sign);
  *rays = select_SceneRay(*rays, first, begun.lanes);
  *paths = select_PathState(*paths, start_path(scene, &begun.at, begun.lanes), begun.lanes);
  return begun.lanes;
}

// The surfaces that the paths of `lanes` have met cover their part of the pixels.
#if HAS_MATTES
static inline void add_mattes(const Scene* scene, const Launch* launch, const LaneWork* work,
                              const PathStates* paths, MASK lanes, __global float4* restrict film) {
  EACH_LANE(lane, lanes & MASK_OF(paths->matte != 0.0f)) {
    add_matte(scene, sample_sums(launch, film, (u32)MASK_LANE(work->place, lane)),
              MASK_LANE(paths->instance, lane), MASK_LANE(paths->material, lane),
              work->sign[lane] * REAL_LANE(paths->matte, lane));
  }
}
#endif

// Adds the parts of the light `all` of samples that have ended, as store_sample() adds that.
#if HAS_LIGHT_SUMS
static inline void add_part(const Launch* launch, const LaneWork* work, const REAL3* light,
                            const float* shares, MASK lanes, u32 part, __global float4* restrict film) {
  EACH_LANE(lane, lanes) {
    const u32 place = (u32)MASK_LANE(work->place, lane);
    __global float* sum =
        (__global float*)(sample_sums(launch, film, place) + FIRST_LIGHT_VECTOR) + 3u * part;
    const float3 added = shares[lane] * get3(light, lane);
    sum[0] += added.x;
    sum[1] += added.y;
    sum[2] += added.z;
  }
}

#define ADD_PART(name)                                                                        \
  {                                                                                           \
    const REAL3 light = spectrum_seen(scene, &paths->wavelengths, &paths->parts.name, lanes); \
    add_part(launch, work, &light, shares, lanes, part++, film);                              \
  }
NEVER_INLINE void add_light_parts(const Scene* scene, const Launch* launch, const LaneWork* work,
                                  const PathStates* paths, const REAL3* all, MASK lanes,
                                  __global float4* restrict film) {
  float shares[BATCH];
  EACH_LANE(lane, lanes) {
    const float3 light = get3(all, lane);
    shares[lane] = work->sign[lane] * limiting_share(light, scene->info->max_component);
    if (!all_finite(light)) MASK_LANE(lanes, lane) = 0;
  }
  u32 part = 0u;
  LIGHT_PARTS(ADD_PART)
}
#endif

// One work-item of the kernel below: items [first, end).
NEVER_INLINE void render_items(const Scene* scene, MediaStack around, const Launch* launch, u32 first,
                               u32 end, __global const u32* restrict pixels, __global float4* restrict film,
                               __global float* restrict weights, __global u32* restrict counters,
                               __global u32* restrict ray_counts) {
  u32 counts[ALL_COUNTS];
  for (u32 i = 0; i < ALL_COUNTS; ++i) counts[i] = 0;
  for (u32 item = first; item < end; ++item) begin_film(launch, item, film, weights, ray_counts);
  LaneWork work = begin_work(scene, first, end);
  const Rays none = camera_rays(scene->info, (REAL)(0.0f), (REAL)(0.0f));
  PathStates paths = start_path(scene, &work.at, NO_LANES);
  SceneRays rays = scene_rays(&none, around);
  MASK lanes = NO_LANES;
  for (;;) {
    const MASK begun =
        fill_idle_lanes(scene, launch, pixels, around, ~lanes, &work, &paths, &rays, counts, ray_counts);
    const MASK going = lanes | begun;
    if (!any_lane(going)) break;
    counts[COUNT_PRIMARY] += lane_count(begun);
    note_own_rays(begun, counts);
    start_marching(counts);
    lanes = going & step_path(scene, &paths, &rays, !any_lane(lanes), counts, going);
    HAVING(HAS_MATTES, add_mattes(scene, launch, &work, &paths, going, film);)
    const MASK over = going & ~lanes;
    if (!any_lane(over)) continue;
    const REAL3 seen = spectrum_seen(scene, &paths.wavelengths, &paths.radiance, over);
    const REAL alpha = coverage_of(&paths, over);
    EACH_LANE(lane, over) {
      const float4 radiance = (float4)(get3(&seen, lane), REAL_LANE(alpha, lane)),
                   limited = limit_components(radiance, scene->info->max_component);
      store_sample((u32)MASK_LANE(work.place, lane), limited, work.sign[lane], film, weights, counts);
    }
    HAVING(HAS_LIGHT_SUMS, add_light_parts(scene, launch, &work, &paths, &seen, over, film);)
  }
  add_counts(counters, counts);
  add_finished(counters, counts[COUNT_PRIMARY], launch->sample_count);
}

// Reads the scene; adds samples [first_sample, first_sample + sample_count) of the pixels of items
// [first_item, last_item) of the rectangle (x0, y0, width, height), or of the image's pixels that it stands
// for (`pixels`, where the launch is of a list), to film (rgb and coverage) and their number to weights, as
// render_whitted does; adds to counters and ray_counts.
__kernel void render_path(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                          __global const u32* restrict pixels, __global float4* restrict film,
                          __global float* restrict weights, __global u32* restrict counters,
                          __global u32* restrict ray_counts, const Launch launch) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 place = get_global_id(1) * launch.row_items + get_global_id(0),
            first = launch.first_item + place * launch.run;
  if (get_global_id(0) >= launch.row_items || first >= launch.last_item) return;
  render_items(&scene, (MediaStack)camera_media[1] << 32 | camera_media[0], &launch, first,
               min(first + launch.run, launch.last_item), pixels, film, weights, counters_of(counters, first),
               ray_counts);
}
