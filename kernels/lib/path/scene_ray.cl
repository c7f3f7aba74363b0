// Rays on their way through the scene, a ray a lane, with what travels along, and how they start again from
// what they met.
#ifndef SUNDOG_LIB_SCENE_RAY_CL
#define SUNDOG_LIB_SCENE_RAY_CL
#include "lib/core/tables.h"
#include "lib/path/camera.cl"
#include "lib/path/media.cl"
#include "lib/trace/hits.cl"

#define FROM_NOWHERE (-1)

// Rays in world space with what travels along.
typedef struct SceneRays {
  REAL3 o, d;  // d unit
  REAL t_min, t_max;
  MASK media_low, media_high;  // the words of the MediaStack at t_min
#if HAS_MEDIA
  REAL since;  // distance from which on they are in their medium
#endif
#if RAYS_CROSS
  MASK crossings;  // unseen interfaces or filters behind them
#endif
#if HAS_SDF
  MASK from;       // the field that it starts on: instance * 2, plus 1 inside of it; else FROM_NOWHERE
  REAL footprint;  // of the pixel at o, in world units
#endif
#if HAS_CONES
  REAL cone_width, cone_spread;  // of the cone at o, in world units; its growth on a unit of the way
#endif
#if HAS_GLOW
  REAL3 glow;  // gathered from fields that it passed
#endif
#if HAS_OBJECT_MOTION
  REAL time;  // one for a whole path
#endif
} SceneRays;

// What rays carry in some scenes only, from their start and past surfaces, and as others in their lanes;
// without the feature nothing.
#if HAS_MEDIA
static inline void start_in_medium(SceneRays* rays) { rays->since = (REAL)(0.0f); }
static inline void join_medium(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->since = select(rays->since, others->since, lanes);
}
#else
static inline void start_in_medium(SceneRays* rays) {}
static inline void join_medium(SceneRays* rays, const SceneRays* others, MASK lanes) {}
#endif

#if RAYS_CROSS
static inline void forget_crossings(SceneRays* rays) { rays->crossings = NO_LANES; }
static inline void count_crossings(SceneRays* rays, MASK lanes) { rays->crossings -= lanes; }
static inline MASK may_cross(const SceneRays* rays) { return MASK_OF(rays->crossings < MAX_CROSSINGS); }
// The rays of `lanes` continue `before`, which have crossed one interface more.
static inline void cross_further(const SceneRays* before, MASK lanes, SceneRays* rays) {
  rays->crossings = select(rays->crossings, before->crossings + 1, lanes);
}
static inline void join_crossings(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->crossings = select(rays->crossings, others->crossings, lanes);
}
#else
static inline void join_crossings(SceneRays* rays, const SceneRays* others, MASK lanes) {}
static inline void forget_crossings(SceneRays* rays) {}
static inline void count_crossings(SceneRays* rays, MASK lanes) {}
static inline MASK may_cross(const SceneRays* rays) { return NO_LANES; }
static inline void cross_further(const SceneRays* before, MASK lanes, SceneRays* rays) {}
#endif

#if HAS_SDF
static inline void start_off_fields(SceneRays* rays) {
  rays->from = (MASK)(FROM_NOWHERE);
  rays->footprint = (REAL)(0.0f);
}
static inline void widen_footprints(__global const SceneInfo* restrict info, SceneRays* rays, REAL t,
                                    MASK lanes) {
  rays->footprint = select(rays->footprint, fma(t, (REAL)(pixel_spread(info)), rays->footprint), lanes);
}
// Records which field, and which side of it, each ray in `lanes` restarts from.
static inline void start_on_hits(__global const SceneInfo* restrict info, SceneRays* rays, const Hits* hits,
                                 MASK inside, MASK lanes) {
  const MASK on_field = MASK_OF(hits->instance >= (int)info->instance_count);
  const MASK from = select((MASK)(FROM_NOWHERE), hits->instance * 2 - inside, on_field);
  rays->from = select(rays->from, from, lanes);
}
static inline void join_footprints(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->from = select(rays->from, others->from, lanes);
  rays->footprint = select(rays->footprint, others->footprint, lanes);
}
#else
static inline void join_footprints(SceneRays* rays, const SceneRays* others, MASK lanes) {}
static inline void start_off_fields(SceneRays* rays) {}
static inline void widen_footprints(__global const SceneInfo* restrict info, SceneRays* rays, REAL t,
                                    MASK lanes) {}
static inline void start_on_hits(__global const SceneInfo* restrict info, SceneRays* rays, const Hits* hits,
                                 MASK inside, MASK lanes) {}
#endif

#if HAS_CONES
static inline void join_cones(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->cone_width = select(rays->cone_width, others->cone_width, lanes);
  rays->cone_spread = select(rays->cone_spread, others->cone_spread, lanes);
}
static inline void start_camera_cones(SceneRays* rays, const Rays* camera) {
  rays->cone_width = (REAL)(0.0f);
  rays->cone_spread = camera->spread;
}
static inline void widen_cones(SceneRays* rays, REAL t, MASK lanes) {
  rays->cone_width = select(rays->cone_width, fma(t, rays->cone_spread, rays->cone_width), lanes);
}
#else
static inline void join_cones(SceneRays* rays, const SceneRays* others, MASK lanes) {}
static inline void start_camera_cones(SceneRays* rays, const Rays* camera) {}
static inline void widen_cones(SceneRays* rays, REAL t, MASK lanes) {}
#endif

#if HAS_GLOW
static inline void forget_glow(SceneRays* rays) { rays->glow = all3((float3)(0.0f)); }
static inline void join_glow(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->glow = select3(rays->glow, others->glow, lanes);
}
#else
static inline void join_glow(SceneRays* rays, const SceneRays* others, MASK lanes) {}
static inline void forget_glow(SceneRays* rays) {}
#endif

#if HAS_OBJECT_MOTION
static inline void start_at_time(SceneRays* rays, const Rays* camera) { rays->time = camera->time; }
static inline void join_ray_times(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->time = select(rays->time, others->time, lanes);
}
static inline REAL time_of_rays(const SceneRays* rays) { return rays->time; }
#else
static inline void start_at_time(SceneRays* rays, const Rays* camera) {}
static inline void join_ray_times(SceneRays* rays, const SceneRays* others, MASK lanes) {}
static inline REAL time_of_rays(const SceneRays* rays) { return (REAL)(0.0f); }
#endif

static inline SceneRays scene_rays(const Rays* camera, MediaStack media) {
  SceneRays rays;
  rays.o = camera->o;
  rays.d = camera->d;
  rays.t_min = camera->t_min;
  rays.t_max = camera->t_max;
  rays.media_low = (MASK)((int)media);
  rays.media_high = (MASK)((int)(media >> 32));
  start_in_medium(&rays);
  forget_crossings(&rays);
  start_off_fields(&rays);
  start_camera_cones(&rays, camera);
  forget_glow(&rays);
  start_at_time(&rays, camera);
  return rays;
}

// The lanes of `lanes` become those of `others`.
static inline void join_rays(SceneRays* rays, const SceneRays* others, MASK lanes) {
  rays->o = select3(rays->o, others->o, lanes);
  rays->d = select3(rays->d, others->d, lanes);
  rays->t_min = select(rays->t_min, others->t_min, lanes);
  rays->t_max = select(rays->t_max, others->t_max, lanes);
  rays->media_low = select(rays->media_low, others->media_low, lanes);
  rays->media_high = select(rays->media_high, others->media_high, lanes);
  join_medium(rays, others, lanes);
  join_crossings(rays, others, lanes);
  join_footprints(rays, others, lanes);
  join_cones(rays, others, lanes);
  join_glow(rays, others, lanes);
  join_ray_times(rays, others, lanes);
}

static inline MediaStack get_media(const SceneRays* rays, u32 i) {
  return (MediaStack)(u32)MASK_LANE(rays->media_high, i) << 32 | (u32)MASK_LANE(rays->media_low, i);
}
static inline void set_media(SceneRays* rays, u32 i, MediaStack stack) {
  MASK_LANE(rays->media_low, i) = (int)stack;
  MASK_LANE(rays->media_high, i) = (int)(stack >> 32);
}

// The media of the lanes of `lanes`.
static inline MASK current_media(__global const Medium* restrict media, const SceneRays* rays, MASK lanes) {
  MASK current = NO_LANES;
  const MASK somewhere = lanes & MASK_OF((rays->media_low | rays->media_high) != 0);
  for (u32 bits = lane_bits(somewhere); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    MASK_LANE(current, i) = (int)current_medium(media, get_media(rays, i));
  }
  return current;
}

// New rays, whose origins are the hits of `rays`, restart from the sides `inside`; `rays` are still the ones
// that hit.
static inline void start_on_surfaces(__global const SceneInfo* restrict info, SceneRays* rays,
                                     const Hits* hits, MASK inside, MASK lanes) {
  widen_footprints(info, rays, hits->t, lanes);
  widen_cones(rays, hits->t, lanes);
  forget_glow(rays);
  start_in_medium(rays);
  forget_crossings(rays);
  start_on_hits(info, rays, hits, inside, lanes);
}

// The lanes of `lanes` continue behind a surface that they do not see.
static inline void continue_behind(__global const SceneInfo* restrict info, SceneRays* rays, const Hits* hits,
                                   MASK entering, MASK lanes) {
  rays->t_min = select(rays->t_min, hits->t, lanes);
  count_crossings(rays, lanes);
  start_on_hits(info, rays, hits, entering, lanes);
}

#endif
