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
} SceneRays;

static inline void forget_glow(SceneRays* rays) {
#if HAS_GLOW
  rays->glow = all3((float3)(0.0f));
#endif
}

static inline SceneRays scene_rays(const Rays* camera, MediaStack media) {
  SceneRays rays;
  rays.o = camera->o;
  rays.d = camera->d;
  rays.t_min = camera->t_min;
  rays.t_max = camera->t_max;
  rays.media_low = (MASK)((int)media);
  rays.media_high = (MASK)((int)(media >> 32));
#if HAS_MEDIA
  rays.since = (REAL)(0.0f);
#endif
#if RAYS_CROSS
  rays.crossings = NO_LANES;
#endif
#if HAS_SDF
  rays.from = (MASK)(FROM_NOWHERE);
  rays.footprint = (REAL)(0.0f);
#endif
#if HAS_CONES
  rays.cone_width = (REAL)(0.0f);
  rays.cone_spread = camera->spread;
#endif
  forget_glow(&rays);
  return rays;
}

static inline MediaStack get_media(const SceneRays* rays, u32 i) {
  return (MediaStack)(u32)MASK_LANE(rays->media_high, i) << 32 | (u32)MASK_LANE(rays->media_low, i);
}
static inline void set_media(SceneRays* rays, u32 i, MediaStack stack) {
  MASK_LANE(rays->media_low, i) = (int)stack;
  MASK_LANE(rays->media_high, i) = (int)(stack >> 32);
}

// The media that the lanes of `lanes` are in.
static inline MASK current_media(__global const Medium* restrict media, const SceneRays* rays, MASK lanes) {
  MASK current = NO_LANES;
  const MASK somewhere = lanes & MASK_OF((rays->media_low | rays->media_high) != 0);
  for (u32 bits = lane_bits(somewhere); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    MASK_LANE(current, i) = (int)current_medium(media, get_media(rays, i));
  }
  return current;
}

// Records which field, and which side of it, each ray in `lanes` restarts from.
static inline void start_on_hits(__global const SceneInfo* restrict info, SceneRays* rays, const Hits* hits,
                                 MASK inside, MASK lanes) {
#if HAS_SDF
  const MASK on_field = MASK_OF(hits->instance >= (int)info->instance_count);
  const MASK from = select((MASK)(FROM_NOWHERE), hits->instance * 2 - inside, on_field);
  rays->from = select(rays->from, from, lanes);
#endif
}

// The same for new rays, whose origins are the hits; `rays` are still the ones that hit.
static inline void start_on_surfaces(__global const SceneInfo* restrict info, SceneRays* rays,
                                     const Hits* hits, MASK inside, MASK lanes) {
#if HAS_SDF
  rays->footprint = select(rays->footprint, fma(hits->t, (REAL)(pixel_spread(info)), rays->footprint), lanes);
#endif
#if HAS_CONES
  rays->cone_width = select(rays->cone_width, fma(hits->t, rays->cone_spread, rays->cone_width), lanes);
#endif
  forget_glow(rays);
#if HAS_MEDIA
  rays->since = (REAL)(0.0f);
#endif
#if RAYS_CROSS
  rays->crossings = NO_LANES;
#endif
  start_on_hits(info, rays, hits, inside, lanes);
}

// The lanes of `lanes` continue behind a surface that they do not see.
static inline void continue_behind(__global const SceneInfo* restrict info, SceneRays* rays, const Hits* hits,
                                   MASK entering, MASK lanes) {
  rays->t_min = select(rays->t_min, hits->t, lanes);
#if RAYS_CROSS
  rays->crossings -= lanes;
#endif
  start_on_hits(info, rays, hits, entering, lanes);
}

#endif
