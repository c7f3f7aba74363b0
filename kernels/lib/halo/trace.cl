// Traces sunlight through crystals of one kind to the map of the sky.
#pragma once
#include "lib/halo/exits.cl"
#include "lib/halo/sky_map.cl"

// Weights by destination (HALO_SENT, ...), one sum per lane.
typedef struct HaloSums {
  MASK sum[HALO_TALLIES];
} HaloSums;

ALWAYS_INLINE void halo_tally(HaloSums* sums, u32 which, REAL weight, MASK lanes) {
  sums->sum[which] += TO_MASK(weight * HALO_TALLY_UNITS + 0.5f) & lanes;
}

// Light leaving in its original direction (through parallel faces) is no halo: it appears at the sun.
ALWAYS_INLINE void halo_leave(const HaloLaunch* launch, HALO_MAP map, HaloRays* rays, const HaloExits* exits,
                              MASK lanes, HaloSums* sums) {
  const MASK straight = MASK_OF(halo_dot(exits->d, rays->sunlight) > 0.999995f) & lanes;
  halo_tally(sums, HALO_PASSED, exits->weight, straight);
  halo_tally(sums, HALO_TURNED, exits->weight, lanes & ~straight);
  halo_count(launch, map, rays, exits, lanes & ~straight);
}

// Work-item `item`: LANES * HALO_RAYS_A_LANE rays. Adds to `sums`.
NEVER_INLINE void halo_item(const HaloLaunch* launch, HALO_MAP map, u32 item, HaloSums* sums) {
  MASK lane = NO_LANES;
  for (u32 i = 0; i < LANES; ++i) MASK_LANE(lane, i) = (int)i;
  for (u32 round = 0; round < HALO_RAYS_A_LANE; ++round) {
    const u32 begin = (item * HALO_RAYS_A_LANE + round) * LANES;
    if (begin >= launch->count) return;
    MASK active = MASK_OF(lane < (int)(launch->count - begin)), side;
    HaloRays rays;
    HaloExits exits = halo_enter(launch, lane + (int)(launch->first + begin), &rays);
    halo_tally(sums, HALO_SENT, rays.weight + exits.weight, active);
    halo_leave(launch, map, &rays, &exits, active, sums);
    for (u32 bounce = 0; bounce < HALO_BOUNCES && any_lane(active); ++bounce) {
      exits = halo_bounce(launch, &rays, &side);
      halo_leave(launch, map, &rays, &exits, active, sums);
      const MASK ends = active & MASK_OF(rays.weight < HALO_LEAST);
      halo_tally(sums, HALO_KEPT, rays.weight, ends);
      active &= ~ends;
    }
    halo_tally(sums, HALO_KEPT, rays.weight, active);
  }
}
