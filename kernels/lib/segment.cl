// A batch of rays from their starts to the next surfaces that they can see: interfaces overruled by priority
// are crossed on the way, the media stack is kept and absorption is gathered.
#ifndef SUNDOG_LIB_SEGMENT_CL
#define SUNDOG_LIB_SEGMENT_CL
#include "lib/config.h"
#include "lib/media.cl"
#include "lib/nearest.cl"
#include "lib/optics.cl"
#include "lib/surface.cl"

// What a ray meets. `before` and `after` are the media on the two sides as the ray crosses; equal where
// nothing is crossed.
typedef struct Encounter {
  Hit hit;
  u32 material;
  u32 before, after;
  bool entering;
  float3 absorbed;  // factor on the ray's light from its start to the hit
} Encounter;

// There is nothing to see where both sides are one medium, nor where a clear material parts media of equal
// index.
static inline bool is_invisible(__global const Medium* restrict media, const Encounter* e, u32 flags) {
  return e->after == e->before ||
         ((flags & MATERIAL_CLEAR) && media[e->after].absorption.w == media[e->before].absorption.w);
}

static inline void identify(TRACE_PARAMETERS, SHADE_PARAMETERS, const SceneRay* ray, Encounter* e) {
  e->material = hit_material(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &e->hit);
  e->entering = dot(outward_normal(TRACE_ARGUMENTS, &e->hit), ray->d) < 0.0f;
}

#if HAS_MEDIA
// The ray at e->hit, having come from `from`: whether it goes on through an invisible interface. Then its
// stack, its t_min and `from` are what holds behind.
static inline bool crosses_unseen(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRay* ray, Encounter* e,
                                  float* from, u32 crossing, u32* counts) {
  const u32 here = current_medium(media, ray->media);
  e->before = here;
  e->after = here;
  if (e->hit.instance == NO_INSTANCE) {
    e->absorbed *= absorb(media, here, ray->t_max - *from);
    return false;
  }
  identify(TRACE_ARGUMENTS, SHADE_ARGUMENTS, ray, e);
  const u32 flags = materials[e->material].flags;
  const bool interface = (flags & MATERIAL_TRANSMITS) && !(flags & MATERIAL_THIN);
  if (interface) {
    MediaStack crossed = ray->media;
    if (!cross_boundary(&crossed, materials[e->material].medium, e->entering))
      counts[e->entering ? COUNT_MEDIA_STACK_OVERFLOW : COUNT_STRAY_EXIT] += 1u;
    e->after = current_medium(media, crossed);
    if (is_invisible(media, e, flags) && crossing < MAX_CROSSINGS) {
      if (e->after != e->before) {
        e->absorbed *= absorb(media, here, e->hit.t - *from);
        *from = e->hit.t;
      }
      ray->media = crossed;
      continue_behind(instances, ray, &e->hit, e->entering);
      return true;
    }
  }
  e->absorbed *= absorb(media, here, e->hit.t - *from);
  return false;
}
#endif

// Follows the first `count` of rays in (t_min, t_max] to their next visible surfaces. A ray's media are those
// at its start, and afterwards those just before the surface. Crossed interfaces do not move the origin, so
// what lies behind a vanished interface keeps its bits. `coherent`: the rays run close together.
static inline void next_surfaces(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRay* rays, u32 count, bool coherent,
                                 Encounter* met, u32* counts) {
  Hit hits[BATCH];
  u32 waiting[BATCH];
  for (u32 i = 0; i < count; ++i) waiting[i] = i;
#if HAS_MEDIA
  float from[BATCH];
  for (u32 i = 0; i < count; ++i) {
    from[i] = 0.0f;
    met[i].absorbed = (float3)(1.0f);
  }
  for (u32 crossing = 0; count; ++crossing) {
    nearest_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, waiting, count, coherent && crossing == 0u, false,
                 hits, counts);
    u32 left = 0;
    for (u32 k = 0; k < count; ++k) {
      const u32 i = waiting[k];
      met[i].hit = hits[k];
      if (crosses_unseen(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &rays[i], &met[i], &from[i], crossing, counts))
        waiting[left++] = i;
    }
    count = left;
  }
#else
  nearest_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, waiting, count, coherent, false, hits, counts);
  for (u32 i = 0; i < count; ++i) {
    met[i].hit = hits[i];
    met[i].before = 0;
    met[i].after = 0;
    met[i].absorbed = (float3)(1.0f);
    if (hits[i].instance != NO_INSTANCE) identify(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &rays[i], &met[i]);
  }
#endif
}

// Index of the transmitting side over that of the incident side.
static inline float relative_index(__global const Medium* restrict media, const Encounter* e) {
#if HAS_MEDIA
  return media[e->after].absorption.w / media[e->before].absorption.w;
#else
  return 1.0f;
#endif
}

#endif
