// One stage: sunlight through ice crystals, into a map of the sky. Not a part of any frame: the map becomes
// an environment's picture before a scene is compiled.
#include "lib/core/lanes.h"
#include "shared/halo.h"

static inline void add_to_cells(__global u32* restrict map, MASK cell, MASK units, MASK lanes) {
  EACH_LANE(i, lanes) atomic_add(map + MASK_LANE(cell, i), (u32)MASK_LANE(units, i));
}
#include "plain/halo/trace.cl"

// Adds the rays of `launch` to `map` (units of light by cells, launch.side a side) and to `tallies`
// (HALO_TALLIES pairs of words, low and high). Sums of integers: no order of the work changes them.
__kernel void trace_halo(__global u32* restrict map, __global u32* restrict tallies, HaloLaunch launch) {
  HaloSums sums = {{0}};
  const MASK first = LANE_NUMBERS + (int)(get_global_id(0) * HALO_RAYS_A_LANE * LANES);
  trace_crystals(&launch, map, AS_UINTS(first), LANES, &sums, ALL_LANES);
  for (u32 i = 0; i < HALO_TALLIES; ++i) {
    u32 sum = 0;
    for (u32 lane = 0; lane < LANES; ++lane) sum += (u32)MASK_LANE(sums.weights[i], lane);
    if (sum && atomic_add(tallies + 2u * i, sum) > 0xffffffffu - sum) atomic_inc(tallies + 2u * i + 1u);
  }
}
