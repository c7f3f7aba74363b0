// A batch of rays from their starts to the next surfaces that they can see: interfaces overruled by priority
// are crossed on the way, the media stack is kept and absorption is gathered.
#ifndef SUNDOG_LIB_SEGMENT_CL
#define SUNDOG_LIB_SEGMENT_CL
#include "lib/core/config.h"
#include "lib/path/faces.cl"
#include "lib/path/media.cl"
#include "lib/path/nearest.cl"
#include "lib/path/touching.cl"

// What rays meet. `before` and `after` are the media on the two sides as a ray crosses; equal where nothing
// is crossed.
typedef struct Encounters {
  Hits hit;
  Faces face;
  MASK before, after;
  REAL3 absorbed;  // factor on the ray's light from its start to the hit
#if HAS_TOUCHING
  MASK behind_low, behind_high;  // the words of the MediaStack behind
  REAL apart;                    // how far the faces that touch there may be apart
#endif
#if HAS_PARALLAX
  REAL below;  // how far the hit is below a surface in whose relief it lies; 0 elsewhere
  REAL3 top;   // that surface's normal
#endif
} Encounters;

// The part of light from the rays' ends that the world's fog lets through, of the rays of `lanes` that were
// not inside anything.
static inline REAL clear_of_fog(const Scene* scene, const Encounters* met, MASK lanes) {
  const MASK foggy = lanes & MASK_OF(met->before == 0);
  return select((REAL)(1.0f), real_exp(-scene->info->fog.w * met->hit.t), foggy);
}

#if HAS_TOUCHING
static inline void set_behind(Encounters* met, u32 i, MediaStack stack) {
  MASK_LANE(met->behind_low, i) = (int)stack;
  MASK_LANE(met->behind_high, i) = (int)(stack >> 32);
}
// The lanes of `lanes` have met nothing that changes the media `low` and `high`.
static inline void stay_in_media(Encounters* met, MASK low, MASK high, MASK lanes) {
  met->behind_low = select(met->behind_low, low, lanes);
  met->behind_high = select(met->behind_high, high, lanes);
  met->apart = select(met->apart, (REAL)(0.0f), lanes);
}
static inline void forget_behind(Encounters* met) {
  met->behind_low = NO_LANES;
  met->behind_high = NO_LANES;
  met->apart = (REAL)(0.0f);
}
#else
static inline void set_behind(Encounters* met, u32 i, MediaStack stack) {}
static inline void stay_in_media(Encounters* met, MASK low, MASK high, MASK lanes) {}
static inline void forget_behind(Encounters* met) {}
#endif

// Takes the faces of the hits of `lanes` into `met`.
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
// Lane i at an interface behind which the media are `crossed`. There is nothing to see where both sides are
// one medium, nor where a clear material parts media of equal index; then the ray's stack becomes the one
// behind. Returns whether that is so.
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

// The stack of media behind the interface that lane i has met.
static inline MediaStack media_behind(const SceneRays* rays, const Encounters* met, u32 i, u32* counts) {
  const bool entering = MASK_LANE(met->face.entering, i);
  MediaStack crossed = get_media(rays, i);
  if (!cross_boundary(&crossed, (u32)MASK_LANE(met->face.medium, i), entering))
    counts[entering ? COUNT_MEDIA_STACK_OVERFLOW : COUNT_STRAY_EXIT] += 1u;
  return crossed;
}

#define INTERFACE (MATERIAL_TRANSMITS | MATERIAL_THIN)  // flags to look at: an interface only transmits

#if HAS_TOUCHING
// The lanes of `lanes`, whose faces may touch others. Returns those that continue, as in cross_unseen().
static inline MASK cross_touching(const Scene* scene, SceneRays* rays, Encounters* met, MASK lanes,
                                  u32* counts) {
  MASK unseen = NO_LANES;
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    Seen seen;
    float apart;
    const float end = meet_touching(scene, rays, i, MATERIAL_TRANSMITS, &met->hit, &met->face, &seen, &apart);
    REAL_LANE(met->apart, i) = apart;
    set_behind(met, i, seen.behind);
    counts[COUNT_MEDIA_STACK_OVERFLOW] += seen.overflows;
    counts[COUNT_STRAY_EXIT] += seen.strays;
    if (((u32)MASK_LANE(met->face.flags, i) & INTERFACE) != MATERIAL_TRANSMITS) continue;
    if (!cross_if_unseen(scene->media, rays, met, i, seen.behind)) continue;
    MASK_LANE(unseen, i) = -1;
    REAL_LANE(met->hit.t, i) = end;
  }
  return unseen;
}
#else
static inline MASK cross_touching(const Scene* scene, SceneRays* rays, Encounters* met, MASK lanes,
                                  u32* counts) {
  return NO_LANES;
}
#endif

// The lanes of `waiting` at their next hits. Returns those that continue through invisible interfaces: their
// rays are then what holds behind.
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
  MASK unseen = cross_touching(scene, rays, met, touching, counts);
  for (u32 bits = lane_bits(interface); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
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
  forget_behind(met);
}

// The lanes of `active` at the interfaces met->hit. Returns those that cannot see them: their rays are then
// what holds behind. The media of the others are those just before the surface. Crossed interfaces do not
// move the origin, so what lies behind a vanished interface keeps its bits.
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

// The camera's rays of `lanes` go on behind lamps that are hidden from them. Returns those.
#if HAS_MEDIA
static inline void end_stretch(SceneRays* rays, const Hits* hits, MASK lanes) {
  rays->since = select(rays->since, hits->t, lanes);
}
#else
static inline void end_stretch(SceneRays* rays, const Hits* hits, MASK lanes) {}
#endif
static inline MASK pass_hidden(const Scene* scene, SceneRays* rays, const Encounters* met, MASK lanes) {
  if (!HAS_EMISSION) return NO_LANES;
  const MASK hidden =
      lanes & hit_anything(&met->hit) & MASK_OF((met->face.flags & (int)MATERIAL_OFF_CAMERA) != 0);
  if (!any_lane(hidden)) return NO_LANES;
  end_stretch(rays, &met->hit, hidden);
  continue_behind(scene->info, rays, &met->hit, met->face.entering, hidden);
  return hidden;
}

// Whether rays inside of media pass all that they do not see in one walk.
#define LISTS_UNSEEN (LISTS_HITS && HAS_MEDIA && !HAS_PARALLAX)
#if LISTS_UNSEEN
// The priorities of the media that the lanes of `lanes` are in.
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

// The same as meet_interfaces() for rays that do not run close together; most of those returned there are
// taken on at once.
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

// Takes the lanes of `active` in (t_min, t_max] there. `coherent`: the rays run close together.
static inline MASK next_interfaces(const Scene* scene, SceneRays* rays, MASK active, bool coherent,
                                   Encounters* met, u32* counts) {
  nearest_hits(scene, rays, active, coherent, &met->hit, counts);
  return reach_interfaces(scene, rays, active, met, counts);
}

// The same to their next visible surfaces.
static inline void next_surfaces(const Scene* scene, SceneRays* rays, MASK active, bool coherent,
                                 Encounters* met, u32* counts) {
  MASK waiting = next_interfaces(scene, rays, active, coherent, met, counts);
  while (HAS_MEDIA && any_lane(waiting)) {
    Hits hits;
    nearest_hits(scene, rays, waiting, false, &hits, counts);
    met->hit = select_hits(&met->hit, &hits, waiting);
    waiting = cross_unseen(scene, rays, met, waiting, counts);
  }
}

// offset_beyond(): how far off the surface further rays start, where faces that touch may be apart.
// enter_behind(): the children of `lanes`, copies of `rays`, are in the media behind what those have met;
// thin surfaces change none.
#if HAS_TOUCHING
static inline REAL offset_beyond(const Encounters* met, REAL offset) {
  return select(offset, met->apart, MASK_OF(met->apart > 0.0f));
}
static inline void enter_behind(const Encounters* met, const SceneRays* rays, MASK lanes, SceneRays* child) {
  child->media_low = select(child->media_low, met->behind_low, lanes);
  child->media_high = select(child->media_high, met->behind_high, lanes);
}
#else
static inline REAL offset_beyond(const Encounters* met, REAL offset) { return offset; }
static inline void enter_behind(const Encounters* met, const SceneRays* rays, MASK lanes, SceneRays* child) {
  if (!HAS_MEDIA) return;
  const MASK bends = lanes & MASK_OF((met->face.flags & (int)MATERIAL_THIN) == 0);
  for (u32 bits = lane_bits(bends); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    MediaStack crossed = get_media(rays, i);
    cross_boundary(&crossed, (u32)MASK_LANE(met->face.medium, i), MASK_LANE(met->face.entering, i));
    set_media(child, i, crossed);
  }
}
#endif

#endif
