// Moves a batch of rays from their starts to the next visible surfaces: crosses interfaces overruled by
// priority, maintains the media stack and accumulates absorption.
#pragma once
#include "lib/core/config.h"
#include "lib/core/counters.cl"
#include "lib/path/faces.cl"
#include "lib/path/media.cl"
#include "lib/path/nearest.cl"
#include "lib/path/touching.cl"

#define INTERFACE (MATERIAL_TRANSMITS | MATERIAL_THIN)  // flags that tell whether a face only transmits

// A ray's next surface. `before` and `after` are the media on its two sides; equal if nothing is crossed.
typedef struct Encounters {
  Hits hit;
  Faces face;
  MASK before, after;
  REAL3 absorbed;  // factor on the ray's light from its start to the hit
  HAVING(HAS_TOUCHING, MASK behind_low; MASK behind_high;)  // the words of the MediaStack behind
  HAVING(HAS_TOUCHING, REAL apart;)                         // how far apart the touching faces may be
  HAVING(HAS_PARALLAX, REAL below;)  // depth of the hit below a surface in whose relief it lies, or 0
  HAVING(HAS_PARALLAX, REAL3 top;)   // that surface's normal
} Encounters;

// The fraction of light from the rays' ends that the world's fog transmits, for rays of `lanes` outside all
// solids.
static inline REAL clear_of_fog(const Scene* scene, const Encounters* met, MASK lanes) {
  const MASK foggy = lanes & MASK_OF(met->before == 0);
  return select((REAL)(1.0f), real_exp(-scene->info->fog.w * met->hit.t), foggy);
}

static inline void set_behind(Encounters* met, u32 i, MediaStack stack) {
  HAVING(HAS_TOUCHING, MASK_LANE(met->behind_low, i) = (int)stack;)
  HAVING(HAS_TOUCHING, MASK_LANE(met->behind_high, i) = (int)(stack >> 32);)
}
// The hits of `lanes` do not change the media `low` and `high`.
static inline void stay_in_media(Encounters* met, MASK low, MASK high, MASK lanes) {
  HAVING(HAS_TOUCHING, met->behind_low = select(met->behind_low, low, lanes);)
  HAVING(HAS_TOUCHING, met->behind_high = select(met->behind_high, high, lanes);)
  HAVING(HAS_TOUCHING, met->apart = select(met->apart, (REAL)(0.0f), lanes);)
}

// Stores the faces of the hits of `lanes` in `met`.
static inline Faces see_faces(const Scene* scene, const SceneRays* rays, Encounters* met, MASK lanes) {
  const Faces faces = hit_faces(scene, rays->d, &met->hit, lanes);
  met->face.outward = select3(met->face.outward, faces.outward, lanes);
  met->face.entering = select(met->face.entering, faces.entering, lanes);
  met->face.material = select(met->face.material, faces.material, lanes);
  met->face.flags = select(met->face.flags, faces.flags, lanes);
  met->face.medium = select(met->face.medium, faces.medium, lanes);
  return faces;
}

#if HAS_MEDIA
// Lane i at an interface with the media `crossed` behind it. It is unseen if both sides are the same medium,
// or a clear material separates media of equal index; then the ray's stack becomes the one behind. Returns
// whether it is unseen.
static inline bool cross_if_unseen(__global const Medium* restrict media, SceneRays* rays, Encounters* met,
                                   u32 i, MediaStack crossed) {
  const u32 before = (u32)MASK_LANE(met->before, i), after = current_medium(media, crossed);
  MASK_LANE(met->after, i) = (int)after;
  set_behind(met, i, crossed);
  const bool clear = (u32)MASK_LANE(met->face.flags, i) & MATERIAL_CLEAR;
  const bool unseen = after == before || (clear && same_index(media + after, media + before));
  if (!unseen || MASK_LANE(rays->crossings, i) >= MAX_CROSSINGS) return false;
  set_media(rays, i, crossed);
  return true;
}

// Counts media that lane i's stack had no room for, and exits from media that it was not in.
static inline void note_lost_media(u32 i, u32 overflows, u32 strays, u32* counts) {
  counts[COUNT_MEDIA_STACK_OVERFLOW] += overflows;
  counts[COUNT_STRAY_EXIT] += strays;
  if (overflows + strays) counts[LOST_LANES] |= LOST_LANE(i);
}

// The media stack behind the interface that lane i has hit.
static inline MediaStack media_behind(const SceneRays* rays, const Encounters* met, u32 i, u32* counts) {
  const bool entering = MASK_LANE(met->face.entering, i);
  MediaStack crossed = get_media(rays, i);
  if (!cross_boundary(&crossed, (u32)MASK_LANE(met->face.medium, i), entering))
    note_lost_media(i, entering ? 1u : 0u, entering ? 0u : 1u, counts);
  return crossed;
}

#if HAS_TOUCHING
// Crosses faces of `lanes` that may touch others. Returns the lanes that continue, as cross_unseen() does.
static inline MASK cross_touching(const Scene* scene, SceneRays* rays, Encounters* met, MASK lanes,
                                  u32* counts) {
  MASK unseen = NO_LANES;
  EACH_LANE(i, lanes) {
    Seen seen CLEARED_ON_GPUS;
    float apart;
    const float end = meet_touching(scene, rays, i, MATERIAL_TRANSMITS, &met->hit, &met->face, &seen, &apart);
    REAL_LANE(met->apart, i) = apart;
    set_behind(met, i, seen.behind);
    note_lost_media(i, seen.overflows, seen.strays, counts);
    if (((u32)MASK_LANE(met->face.flags, i) & INTERFACE) != MATERIAL_TRANSMITS) continue;
    if (!cross_if_unseen(scene->media, rays, met, i, seen.behind)) continue;
    MASK_LANE(unseen, i) = -1;
    REAL_LANE(met->hit.t, i) = end;
  }
  return unseen;
}
#endif

// Crosses invisible interfaces at the hits of `waiting`. Returns the lanes that continue; their rays then
// have the state behind.
static inline MASK cross_unseen(const Scene* scene, SceneRays* rays, Encounters* met, MASK waiting,
                                u32* counts) {
  const MASK hit = waiting & hit_anything(&met->hit);
  const MASK here = current_media(scene->media, rays, waiting);
  met->before = select(met->before, here, waiting);
  met->after = select(met->after, here, waiting);
  const Faces faces = see_faces(scene, rays, met, hit);
  stay_in_media(met, rays->media_low, rays->media_high, waiting);
  const MASK touching =
      may_touch(scene->instances, &met->hit, hit & MASK_OF((faces.flags & (int)MATERIAL_TRANSMITS) != 0));
  const MASK interface = hit & ~touching & MASK_OF((faces.flags & (int)INTERFACE) == (int)MATERIAL_TRANSMITS);
  MASK unseen = NO_LANES;
  HAVING(HAS_TOUCHING, unseen = cross_touching(scene, rays, met, touching, counts);)
  EACH_LANE(i, interface) {
    if (cross_if_unseen(scene->media, rays, met, i, media_behind(rays, met, i, counts)))
      MASK_LANE(unseen, i) = -1;
  }
  const MASK leaves = (waiting & ~unseen) | (unseen & MASK_OF(met->after != met->before));
  const REAL3 kept = absorb(scene->media, here, met->hit.t - rays->since, leaves);
  met->absorbed = multiply3(met->absorbed, kept);
  if (any_lane(unseen)) {
    rays->since = select(rays->since, met->hit.t, unseen & leaves);
    continue_behind(scene->info, rays, &met->hit, met->face.entering, unseen);
  }
  return unseen;
}

static inline void start_encounters(Encounters* met) {
  met->absorbed = all3((float3)(1.0f));
  met->before = NO_LANES;
  met->after = NO_LANES;
  met->face.outward = all3((float3)(0.0f));
  met->face.entering = NO_LANES;
  met->face.material = NO_LANES;
  met->face.flags = NO_LANES;
  met->face.medium = NO_LANES;
  HAVING(HAS_TOUCHING, met->behind_low = met->behind_high = NO_LANES; met->apart = (REAL)(0.0f);)
}

// Processes the interfaces met->hit of the lanes of `active`. Returns the lanes that do not see them; their
// rays then have the state behind. The media of the others are those just before the surface. Crossed
// interfaces do not move the origin, so hits behind a vanished interface keep their bits.
static inline MASK reach_interfaces(const Scene* scene, SceneRays* rays, MASK active, Encounters* met,
                                    u32* counts) {
  start_encounters(met);
  return cross_unseen(scene, rays, met, active, counts);
}
#else
static inline MASK cross_unseen(const Scene* scene, SceneRays* rays, Encounters* met, MASK waiting,
                                u32* counts) {
  see_faces(scene, rays, met, waiting & hit_anything(&met->hit));
  return NO_LANES;
}
static inline MASK reach_interfaces(const Scene* scene, SceneRays* rays, MASK active, Encounters* met,
                                    u32* counts) {
  met->absorbed = all3((float3)(1.0f));
  met->before = NO_LANES;
  met->after = NO_LANES;
  met->face = hit_faces(scene, rays->d, &met->hit, active & hit_anything(&met->hit));
  return NO_LANES;
}
#endif

// Camera rays of `lanes` continue behind lamps hidden from them. Returns those lanes.
static inline MASK pass_hidden(const Scene* scene, SceneRays* rays, const Encounters* met, MASK lanes) {
  if (!HAS_EMISSION) return NO_LANES;
  const MASK hidden =
      lanes & hit_anything(&met->hit) & MASK_OF((met->face.flags & (int)MATERIAL_OFF_CAMERA) != 0);
  if (!any_lane(hidden)) return NO_LANES;
  HAVING(HAS_MEDIA, rays->since = select(rays->since, met->hit.t, hidden);)
  continue_behind(scene->info, rays, &met->hit, met->face.entering, hidden);
  return hidden;
}

// Whether rays inside media cross all unseen interfaces in one walk.
#define LISTS_UNSEEN (LISTS_HITS && HAS_MEDIA && !HAS_PARALLAX)
#if LISTS_UNSEEN
// The priorities of the media around the lanes of `lanes`.
static inline MASK priorities_around(const Scene* scene, const SceneRays* rays, MASK lanes) {
  MASK priorities = (MASK)((int)0x80000000);
  u32 index;
  const MASK here = current_media(scene->media, rays, lanes);
  for (u32 left = lane_bits(lanes & MASK_OF(here != 0)); left;) {
    const MASK mine = take_alike(here, &left, &index);
    priorities = select(priorities, (MASK)(scene->media[index].priority), mine);
  }
  return priorities;
}

// meet_interfaces() for incoherent rays; continues most of the returned lanes at once.
static inline MASK meet_listed(const Scene* scene, SceneRays* rays, MASK active, Encounters* met,
                               u32* counts) {
  HitList lists[BATCH];
  Hits last, hits;
  MASK listed, unseen = NO_LANES;
  const MASK priorities = priorities_around(scene, rays, active);
  list_batch(scene, &rays->o, &rays->d, &rays->t_min, rays->t_max, time_of_rays(rays), active, &priorities,
             &last, lists);
  start_encounters(met);
  met->hit = last;
  do {
    const MASK again = next_listed(scene, lists, &rays->t_min, active, &last, &hits, &listed);
    active &= ~again;
    met->hit = select_hits(&met->hit, &hits, active);
    const MASK crossing = cross_unseen(scene, rays, met, active, counts);
    unseen |= again | (crossing & ~listed);
    active = crossing & listed;
  } while (any_lane(active));
  return unseen;
}
#else
static inline MASK meet_listed(const Scene* scene, SceneRays* rays, MASK active, Encounters* met,
                               u32* counts) {
  return NO_LANES;
}
#endif

// offset_beyond(): the offset of secondary rays, considering the gap between touching faces. enter_behind():
// the children of `lanes`, copies of `rays`, enter the media behind the hits; thin surfaces change none.
static inline REAL offset_beyond(const Encounters* met, REAL offset) {
  return EITHER(HAS_TOUCHING, select(offset, met->apart, MASK_OF(met->apart > 0.0f)), offset);
}
static inline void enter_behind(const Encounters* met, const SceneRays* rays, MASK lanes, SceneRays* child) {
  HAVING(HAS_TOUCHING, child->media_low = select(child->media_low, met->behind_low, lanes);)
  HAVING(HAS_TOUCHING, child->media_high = select(child->media_high, met->behind_high, lanes);)
  if (HAS_TOUCHING | !HAS_MEDIA) return;
  const MASK bends = lanes & MASK_OF((met->face.flags & (int)MATERIAL_THIN) == 0);
  EACH_LANE(i, bends) {
    MediaStack crossed = get_media(rays, i);
    cross_boundary(&crossed, (u32)MASK_LANE(met->face.medium, i), MASK_LANE(met->face.entering, i));
    set_media(child, i, crossed);
  }
}
