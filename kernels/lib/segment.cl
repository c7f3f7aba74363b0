// A batch of rays from their starts to the next surfaces that they can see: interfaces overruled by priority
// are crossed on the way, the media stack is kept and absorption is gathered.
#ifndef SUNDOG_LIB_SEGMENT_CL
#define SUNDOG_LIB_SEGMENT_CL
#include "lib/config.h"
#include "lib/media.cl"
#include "lib/nearest.cl"
#include "lib/optics.cl"
#include "lib/surface.cl"

// What rays meet. `before` and `after` are the media on the two sides as a ray crosses; equal where nothing
// is crossed.
typedef struct Encounters {
  Hits hit;
  Faces face;
  MASK before, after;
  REAL3 absorbed;  // factor on the ray's light from its start to the hit
} Encounters;

#if HAS_MEDIA
// Lane i at an interface. There is nothing to see where both sides are one medium, nor where a clear material
// parts media of equal index; then the ray's stack becomes the one behind. Returns whether that is so.
static inline bool cross_if_unseen(__global const Medium* restrict media, SceneRays* rays, Encounters* met,
                                   u32 i, u32* counts) {
  const bool entering = MASK_LANE(met->face.entering, i);
  const u32 before = (u32)MASK_LANE(met->before, i);
  MediaStack crossed = get_media(rays, i);
  if (!cross_boundary(&crossed, (u32)MASK_LANE(met->face.medium, i), entering))
    counts[entering ? COUNT_MEDIA_STACK_OVERFLOW : COUNT_STRAY_EXIT] += 1u;
  const u32 after = current_medium(media, crossed);
  MASK_LANE(met->after, i) = (int)after;
  const bool clear = (u32)MASK_LANE(met->face.flags, i) & MATERIAL_CLEAR;
  const bool unseen = after == before || (clear && media[after].absorption.w == media[before].absorption.w);
  if (!unseen || MASK_LANE(rays->crossings, i) >= MAX_CROSSINGS) return false;
  set_media(rays, i, crossed);
  return true;
}

// The lanes of `waiting` at their next hits. Returns those that go on through invisible interfaces: their
// rays are then what holds behind.
static inline MASK cross_unseen(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRays* rays, Encounters* met,
                                MASK waiting, u32* counts) {
  const MASK hit = waiting & hit_anything(&met->hit);
  const MASK here = current_media(media, rays, waiting);
  met->before = select(met->before, here, waiting);
  met->after = select(met->after, here, waiting);
  const Faces faces = hit_faces(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays->d, &met->hit, hit);
  met->face.outward = select3(met->face.outward, faces.outward, hit);
  met->face.entering = select(met->face.entering, faces.entering, hit);
  met->face.material = select(met->face.material, faces.material, hit);
  met->face.flags = select(met->face.flags, faces.flags, hit);
  met->face.medium = select(met->face.medium, faces.medium, hit);
  const int kind = (int)(MATERIAL_TRANSMITS | MATERIAL_THIN);
  const MASK interface = hit & MASK_OF((faces.flags & kind) == (int)MATERIAL_TRANSMITS);
  MASK unseen = NO_LANES;
  for (u32 bits = lane_bits(interface); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    if (cross_if_unseen(media, rays, met, i, counts)) MASK_LANE(unseen, i) = -1;
  }
  const MASK leaves = (waiting & ~unseen) | (unseen & MASK_OF(met->after != met->before));
  const REAL3 kept = absorb(media, here, met->hit.t - rays->since, leaves);
  met->absorbed = multiply3(met->absorbed, kept);
  if (any_lane(unseen)) {
    rays->since = select(rays->since, met->hit.t, unseen & leaves);
    continue_behind(info, rays, &met->hit, faces.entering, unseen);
  }
  return unseen;
}
#endif

// The lanes of `active` at the interfaces met->hit. Returns those that cannot see them: their rays are then
// what holds behind. The media of the others are those just before the surface. Crossed interfaces do not
// move the origin, so what lies behind a vanished interface keeps its bits.
static inline MASK reach_interfaces(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRays* rays, MASK active,
                                    Encounters* met, u32* counts) {
  met->absorbed = all3((float3)(1.0f));
  met->before = NO_LANES;
  met->after = NO_LANES;
#if HAS_MEDIA
  met->face.outward = all3((float3)(0.0f));
  met->face.entering = NO_LANES;
  met->face.material = NO_LANES;
  met->face.flags = NO_LANES;
  met->face.medium = NO_LANES;
  return cross_unseen(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, met, active, counts);
#else
  met->face =
      hit_faces(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays->d, &met->hit, active & hit_anything(&met->hit));
  return NO_LANES;
#endif
}

// Takes the lanes of `active` in (t_min, t_max] there. `coherent`: the rays run close together.
static inline MASK next_interfaces(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRays* rays, MASK active,
                                   bool coherent, Encounters* met, u32* counts) {
  nearest_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, active, coherent, false, &met->hit, counts);
  return reach_interfaces(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, active, met, counts);
}

// The same to their next visible surfaces.
static inline void next_surfaces(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRays* rays, MASK active,
                                 bool coherent, Encounters* met, u32* counts) {
  MASK waiting = next_interfaces(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, active, coherent, met, counts);
  while (any_lane(waiting)) {
#if HAS_MEDIA
    Hits hits;
    nearest_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, waiting, false, false, &hits, counts);
    met->hit = select_hits(&met->hit, &hits, waiting);
    waiting = cross_unseen(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, met, waiting, counts);
#endif
  }
}

// Index of the transmitting side over that of the incident side, for the lanes of `lanes`.
static inline REAL relative_index(__global const Medium* restrict media, const Encounters* met, MASK lanes) {
#if HAS_MEDIA
  return refraction_index(media, met->after, lanes) / refraction_index(media, met->before, lanes);
#else
  return (REAL)(1.0f);
#endif
}

#endif
