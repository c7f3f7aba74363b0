// Rays on their way to the next visible surfaces (plain/path/segment.cl), and interfaces that cannot be seen
// passed in one walk.
#pragma once
#include "lib/core/counters.cl"
#include "lib/path/nearest.cl"

// Counts media that the lanes' stacks had no room for, and exits from media that they were not in.
static inline void note_lost_media(MASK overflows, MASK strays, MASK lanes, u32* counts) {
  EACH_LANE(i, lanes) {
    counts[COUNT_MEDIA_STACK_OVERFLOW] += (u32)MASK_LANE(overflows, i);
    counts[COUNT_STRAY_EXIT] += (u32)MASK_LANE(strays, i);
    if (MASK_LANE(overflows, i) + MASK_LANE(strays, i)) counts[LOST_LANES] |= LOST_LANE(i);
  }
}

#include "lib/path/touching.cl"
#include "plain/path/segment.cl"

// Whether rays inside media cross all unseen interfaces in one walk.
#define LISTS_UNSEEN (LISTS_HITS && HAS_MEDIA && !HAS_PARALLAX)
// meet_interfaces() for incoherent rays; continues most of the returned lanes at once.
static inline MASK meet_listed(const Scene* scene, SceneRays* rays, MASK active, Encounters* met,
                               u32* counts) {
  MASK unseen = NO_LANES;
#if LISTS_UNSEEN
  HitList lists[BATCH];
  Hits last, hits;
  MASK listed;
  const MASK priorities = priority_around(scene, rays, active);
  const TraceRays traced = {&rays->o, &rays->d, &rays->t_min, &last, lists, &priorities};
  list_batch(scene, &traced, rays->t_max, time_of_rays(rays), active);
  start_encounters(met, active);
  met->hit = last;
  do {
    const MASK again = next_listed(scene, lists, &rays->t_min, active, &last, &hits, &listed);
    active &= ~again;
    join_hits(&met->hit, &hits, active);
    const MASK crossing = active & cross_unseen(scene, rays, met, counts, active);
    unseen |= again | (crossing & ~listed);
    active = crossing & listed;
  } while (any_lane(active));
#endif
  return unseen;
}
