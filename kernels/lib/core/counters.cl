// Adds a work-item's ray counts to the launch's with integer atomics, so the order does not matter.
#pragma once
#include "lib/core/config.h"
#include "shared/scene.h"

// The counter that holds a bit of each lane whose ray has lost count of media, until its pixel takes it
// (lib/path/ray_counts.cl). Where a work-item has one lane, registers are scarce: it is the top bit of
// another.
#define LOST_LANES (BATCH > 1 ? COUNT_LOST_PIXEL : COUNT_STRAY_EXIT)
#define LOST_LANE(lane) (1u << (BATCH > 1 ? (lane) : 31u))

// The block of counters that the item uses.
static inline __global u32* counters_of(__global u32* counters, u32 item) {
  return counters + item / COUNTER_ITEMS % COUNTER_BLOCKS * COUNTER_BLOCK;
}

// The counters that a work-item keeps, the first ones.
#define COUNTERS_OF_RAYS (BATCH > 1 ? COUNT_MARCH_STEPS : HAS_PATHS ? COUNT_CUT_OFF : COUNT_LOST_PIXEL)
#define OWN_COUNTERS (HAS_SDF ? COUNTERS : COUNTERS_OF_RAYS)

static inline void add_counts(__global u32* restrict counters, u32* counts) {
  if (HAS_SDF) counts[COUNT_MARCH_LEFT] = 0u;
  if (BATCH > 1) counts[COUNT_LOST_PIXEL] = 0u;
  for (u32 i = 0; i < OWN_COUNTERS; ++i)
    if (counts[i]) atomic_add(counters + i, counts[i]);
}

// A work-item's last act: adds its finished samples twice, in a loop. A driver may silently end all loops of
// a work-item after too many iterations (Mesa's llvmpipe after 65,535 in total), and then this one ends after
// a single iteration. `step`, at least 1, is unknown to the compiler, so that it keeps the loop.
static inline void add_finished(__global u32* restrict counters, u32 amount, u32 step) {
  for (u32 i = 0; i <= step; i += step) atomic_add(counters + COUNT_FINISHED, amount);
}
