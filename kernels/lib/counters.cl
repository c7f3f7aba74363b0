// Adds a work-item's ray counts to the launch's: integer atomics, so the order does not matter.
#ifndef SUNDOG_LIB_COUNTERS_CL
#define SUNDOG_LIB_COUNTERS_CL
#include "shared/scene.h"

static inline void add_counts(__global u32* restrict counters, const u32* counts) {
  for (u32 i = 0; i < COUNTERS; ++i)
    if (counts[i]) atomic_add(counters + i, counts[i]);
}

#endif
