// One stage: the path-traced image of a rectangle of pixels, by unidirectional paths (Kajiya 1986, "The
// Rendering Equation"). A work-item makes TILE_W x TILE_H pixels of several items, a path a lane. A lane
// whose path has ended takes its pixel's next sample, then the first pixel that no lane has taken: lanes are
// seldom idle, and a pixel's samples stay in their order. Shadow rays see what paths that meet lights by
// chance would.
#define HAS_PATHS 1
#define RAYS_BY_LANE 1
#include "lib/core/counters.cl"
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/steps.cl"
#include "plain/path/lens.cl"
#include "plain/pathtracer/bounce.cl"
#include "shared/launch.h"

#define NO_PLACE 0

// The state of a work-item's lanes; their paths hold pixels and samples. All zero means that the item has
// ended: Mesa's llvmpipe (22.3) runs groups in whole vectors, and where a group does not fill one, the
// others loop by the zeros that they read here.
typedef struct LaneWork {
  u32 untaken, end;                       // pixels that no lane has taken yet: BATCH an item
  MASK place;                             // 1 + the lanes' pixels in the rectangle, or NO_PLACE
  HAVING(HAS_FILTER, float sign[BATCH];)  // what the sample counts that the lane is at
  PathStates paths;  // set where lanes begin, as `rays`; of others their samples alone are read
  SceneRays rays;
  HAVING(HAS_ROUGH, LampLights lamps;)  // registers are scarce where surfaces have many lobes
  u32 counts[ALL_COUNTS];
} LaneWork;

static inline float sign_of(const LaneWork* work, u32 lane) {
  return EITHER(HAS_FILTER, work->sign[lane], 1.0f);
}

static inline void begin_work(u32 first, u32 end, LaneWork* work) {
  work->untaken = first * BATCH;
  work->end = end * BATCH;
  work->place = (MASK)(NO_PLACE);
  work->paths.at.sample = NO_LANES;
  for (u32 i = 0; i < ALL_COUNTS; ++i) work->counts[i] = 0;
}

// The lane is done with its pixel and takes the next that no lane has, if there is one.
static inline void take_pixel(const Launch* launch, __global const u32* restrict pixels, u32 lane, u32 seed,
                              LaneWork* work, __global u32* restrict ray_counts) {
  LaneSamples* at = &work->paths.at;
  const int done = MASK_LANE(work->place, lane);
  if (done != NO_PLACE) add_lane_rays(launch, (u32)done - 1u, lane, work->counts, ray_counts);
  MASK_LANE(work->place, lane) = NO_PLACE;
  while (work->untaken < work->end) {
    const u32 taken = work->untaken++;
    const uint2 offset = lane_pixel(launch, taken / BATCH, taken % BATCH);
    uint2 pixel;
    if (!image_pixel(launch, pixels, offset, &pixel)) continue;
    MASK_LANE(at->x, lane) = (int)pixel.x;
    MASK_LANE(at->y, lane) = (int)pixel.y;
    MASK_LANE(at->sample, lane) = (int)launch->first_sample;
    at->seed = seed;
    MASK_LANE(work->place, lane) = (int)(offset.y * launch->width + offset.x) + 1;
    return;
  }
}

// The lanes of `idle` begin with their pixels' next samples. Returns those that have one.
NEVER_INLINE MASK fill_idle_lanes(const Scene* scene, const Launch* launch,
                                  __global const u32* restrict pixels,
                                  __global const u32* restrict camera_media, MASK idle, LaneWork* work,
                                  __global u32* restrict ray_counts) {
  PathStates* paths = &work->paths;
  const int last = (int)(launch->first_sample + launch->sample_count);
  const MASK done = idle & (MASK_OF(paths->at.sample == last) | MASK_OF(work->place == NO_PLACE));
  EACH_LANE(lane, done)
  take_pixel(launch, pixels, lane, scene->info->seed, work, ray_counts);
  const MASK begun = idle & MASK_OF(work->place != NO_PLACE);
  if (!any_lane(begun)) return NO_LANES;
  const MediaStack around = read_media(camera_media);
  REAL sign;
  const SceneRays first = sample_ray(scene, &paths->at, scene->info->samples, &around, &sign, begun);
  HAVING(HAS_FILTER, EACH_LANE(lane, begun) work->sign[lane] = REAL_LANE(sign, lane);)
  work->rays = select_SceneRay(work->rays, first, begun);
  *paths = select_PathState(*paths, start_path(scene, &paths->at, begun), begun);
  return begun;
}

// The surfaces and media that the paths of `lanes` have met cover their part of the pixels.
#if HAS_MATTES
static inline void add_mattes(const Scene* scene, const Launch* launch, const LaneWork* work, MASK lanes,
                              __global float4* restrict film) {
  const PathStates* paths = &work->paths;
  EACH_LANE(lane, lanes & MASK_OF(paths->matte != 0.0f) & MASK_OF(paths->instance != (int)NO_INSTANCE)) {
    add_matte(scene, sample_sums(launch, film, (u32)MASK_LANE(work->place, lane) - 1u),
              MASK_LANE(paths->instance, lane), MASK_LANE(paths->material, lane),
              sign_of(work, lane) * REAL_LANE(paths->matte, lane));
  }
}
#endif

// Adds the parts of the light `all` of samples that have ended, as store_sample() adds that.
#if HAS_LIGHT_SUMS
static inline void add_part(const Launch* launch, const LaneWork* work, const REAL3* light,
                            const float* shares, MASK lanes, u32 part, __global float4* restrict film) {
  EACH_LANE(lane, lanes) {
    const u32 place = (u32)MASK_LANE(work->place, lane) - 1u;
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
                                  const REAL3* all, MASK lanes, __global float4* restrict film) {
  const PathStates* paths = &work->paths;
  float shares[BATCH];
  EACH_LANE(lane, lanes) {
    const float3 light = get3(all, lane);
    shares[lane] = sign_of(work, lane) * limiting_share(light, scene->info->max_component);
    if (!all_finite(light)) MASK_LANE(lanes, lane) = 0;
  }
  u32 part = 0u;
  LIGHT_PARTS(ADD_PART)
}
#endif

// One work-item of the kernel below: items [first, end).
NEVER_INLINE void render_items(const Scene* scene, __global const u32* restrict camera_media,
                               const Launch* launch, u32 first, u32 end, __global const u32* restrict pixels,
                               __global float4* restrict film, __global float* restrict weights,
                               __global u32* restrict counters, __global u32* restrict ray_counts) {
  for (u32 item = first; item < end; ++item) begin_film(launch, item, film, weights, ray_counts);
  KEEP_IN_MEMORY(LaneWork, work);
  begin_work(first, end, work);
  PathStates* paths = &work->paths;
  u32* counts = work->counts;
  MASK lanes = NO_LANES;
  for (;;) {
    const MASK begun = fill_idle_lanes(scene, launch, pixels, camera_media, ~lanes, work, ray_counts);
    const MASK going = lanes | begun;
    if (!any_lane(going)) break;
    counts[COUNT_PRIMARY] += lane_count(begun);
    note_own_rays(begun, counts);
    start_marching(counts);
    EITHER(HAS_ROUGH, LampLights* const lamps = &work->lamps;, LampLights one CLEARED_ON_GPUS;
           LampLights* const lamps = &one;)
    lanes = going & step_path(scene, paths, &work->rays, lamps, !any_lane(lanes), counts, going);
    HAVING(HAS_MATTES, add_mattes(scene, launch, work, going, film);)
    const MASK over = going & ~lanes;
    if (!any_lane(over)) continue;
    const REAL3 seen = spectrum_seen(scene, &paths->wavelengths, &paths->radiance, over);
    const REAL alpha = coverage_of(paths, over);
    EACH_LANE(lane, over) {
      const float4 radiance = (float4)(get3(&seen, lane), REAL_LANE(alpha, lane)),
                   limited = limit_components(radiance, scene->info->max_component);
      store_sample((u32)MASK_LANE(work->place, lane) - 1u, limited, sign_of(work, lane), film, weights,
                   counts);
    }
    HAVING(HAS_LIGHT_SUMS, add_light_parts(scene, launch, work, &seen, over, film);)
    paths->at.sample -= over;  // the mask is -1 in lanes whose path is over: on to their next sample
  }
  __global u32* own = counters_of(counters, first);
  add_counts(own, counts);
  add_finished(own, counts[COUNT_PRIMARY], launch->sample_count);
}

// Reads the scene; adds samples [first_sample, first_sample + sample_count) of the pixels of items
// [first_item, last_item) of the rectangle (x0, y0, width, height), or of the image's pixels that it stands
// for (`pixels`, where the launch is of a list), to film (rgb and coverage) and their number to weights, as
// render_whitted does; adds to counters and ray_counts.
__kernel FOR_WAVES(0) void render_path(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                                       __global const u32* restrict pixels, __global float4* restrict film,
                                       __global float* restrict weights, __global u32* restrict counters,
                                       __global u32* restrict ray_counts, const Launch launch) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 place = get_global_id(1) * launch.row_items + get_global_id(0),
            first = launch.first_item + place * launch.run;
  if (get_global_id(0) >= launch.row_items || first >= launch.last_item) return;
  render_items(&scene, camera_media, &launch, first, min(first + launch.run, launch.last_item), pixels, film,
               weights, counters, ray_counts);
}
