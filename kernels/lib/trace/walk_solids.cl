// Tests rays that reached solids in the same round of walk.cl, each against its own, one ray per lane. Hits
// equal those of hit_solids to the bit.
#pragma once
#include "lib/core/config.h"
#include "lib/core/transform.cl"
#include "lib/trace/hits.cl"

// The rows of an Instance's object_from_world, one instance per lane.
typedef struct TransformLanes {
  REAL m[12];
  MASK moves;  // not the identity
} TransformLanes;

static inline void set_row(REAL* row, u32 lane, float4 r) {
  REAL_LANE(row[0], lane) = r.x;
  REAL_LANE(row[1], lane) = r.y;
  REAL_LANE(row[2], lane) = r.z;
  REAL_LANE(row[3], lane) = r.w;
}

static inline void set_transform(TransformLanes* to, u32 lane, __global const Instance* instance) {
  set_row(to->m, lane, instance->object_from_world[0]);
  set_row(to->m + 4, lane, instance->object_from_world[1]);
  set_row(to->m + 8, lane, instance->object_from_world[2]);
  MASK_LANE(to->moves, lane) = instance->flags & INSTANCE_IDENTITY ? 0 : -1;
}

static inline REAL3 points_by_lane(const TransformLanes* transform, REAL3 p) {
  const REAL* m = transform->m;
  return select3(p,
                 real3(fma(m[0], p.x, fma(m[1], p.y, fma(m[2], p.z, m[3]))),
                       fma(m[4], p.x, fma(m[5], p.y, fma(m[6], p.z, m[7]))),
                       fma(m[8], p.x, fma(m[9], p.y, fma(m[10], p.z, m[11])))),
                 transform->moves);
}

static inline REAL3 vectors_by_lane(const TransformLanes* transform, REAL3 d) {
  const REAL* m = transform->m;
  return select3(d,
                 real3(fma(m[0], d.x, fma(m[1], d.y, m[2] * d.z)), fma(m[4], d.x, fma(m[5], d.y, m[6] * d.z)),
                       fma(m[8], d.x, fma(m[9], d.y, m[10] * d.z))),
                 transform->moves);
}

// Tests the rays of `bits`, which is not 0, against solids[ray]; world-space rays. Those with the same shape
// and parameters are tested together.
NEVER_INLINE void hit_solids_by_lane(__global const Instance* restrict instances, const u32* solids, u32 bits,
                                     const REAL3* o, const REAL3* d, const REAL* t_min, Hits* hits) {
  TransformLanes transform;
  MASK places = NO_LANES;
  do {
    __global const Instance* first = instances + solids[lowest_bit(bits)];
    u32 alike = 0;
    for (u32 left = bits; left; left &= left - 1u) {
      const u32 ray = lowest_bit(left);
      __global const Instance* instance = instances + solids[ray];
      if (instance->shape != first->shape || any(instance->parameters != first->parameters)) continue;
      alike |= 1u << ray;
      set_transform(&transform, ray, instance);
      MASK_LANE(places, ray) = (int)solids[ray];
    }
    bits &= ~alike;
    const REAL3 origins = solids_origins(hits, solids, alike, *o),
                directions = solids_directions(hits, solids, alike, *d);
    offer_solids(first->shape, first->parameters, places, points_by_lane(&transform, origins),
                 vectors_by_lane(&transform, directions), *t_min, lanes_of(alike), hits);
  } while (bits);
}
