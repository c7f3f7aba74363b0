// One ray from its start to the next surface that it can see: interfaces overruled by priority are crossed on
// the way, the media stack is kept and absorption is gathered. The main rays, and the shadow rays with their
// filters, both go through here.
#ifndef SUNDOG_LIB_SEGMENT_CL
#define SUNDOG_LIB_SEGMENT_CL
#include "lib/config.h"
#include "lib/media.cl"
#include "lib/optics.cl"
#include "lib/surface.cl"
#include "lib/traverse.cl"

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

// Follows the ray (o, d) in (t_min, t_max] to the next visible surface. `stack` is the media at its start,
// and afterwards those just before the surface. Crossed interfaces do not move the origin, so what lies
// behind a vanished interface keeps its bits.
static inline Encounter next_surface(TRACE_PARAMETERS, SHADE_PARAMETERS, float3 o, float3 d, float t_min,
                                     float t_max, MediaStack* stack, u32* counts) {
  Encounter e;
  e.absorbed = (float3)(1.0f);
#if HAS_MEDIA
  float from = 0.0f;
  for (u32 crossing = 0;; ++crossing) {
    const u32 here = current_medium(media, *stack);
    e.hit = trace_closest(TRACE_ARGUMENTS, o, d, t_min, t_max);
    e.before = here;
    e.after = here;
    if (e.hit.instance == NO_INSTANCE) {
      e.absorbed *= absorb(media, here, t_max - from);
      return e;
    }
    e.material = hit_material(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &e.hit);
    e.entering = dot(outward_normal(TRACE_ARGUMENTS, &e.hit), d) < 0.0f;
    const u32 flags = materials[e.material].flags;
    const bool interface = (flags & MATERIAL_TRANSMITS) && !(flags & MATERIAL_THIN);
    if (interface) {
      MediaStack crossed = *stack;
      if (!cross_boundary(&crossed, materials[e.material].medium, e.entering))
        counts[e.entering ? COUNT_MEDIA_STACK_OVERFLOW : COUNT_STRAY_EXIT] += 1u;
      e.after = current_medium(media, crossed);
      if (is_invisible(media, &e, flags) && crossing < MAX_CROSSINGS) {
        if (e.after != e.before) {
          e.absorbed *= absorb(media, here, e.hit.t - from);
          from = e.hit.t;
        }
        *stack = crossed;
        t_min = e.hit.t;
        continue;
      }
    }
    e.absorbed *= absorb(media, here, e.hit.t - from);
    return e;
  }
#else
  e.hit = trace_closest(TRACE_ARGUMENTS, o, d, t_min, t_max);
  e.before = 0;
  e.after = 0;
  if (e.hit.instance != NO_INSTANCE) {
    e.material = hit_material(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &e.hit);
    e.entering = dot(outward_normal(TRACE_ARGUMENTS, &e.hit), d) < 0.0f;
  }
  return e;
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
