// A solid against one ray.
#ifndef SUNDOG_LIB_SOLID_INSTANCE_CL
#define SUNDOG_LIB_SOLID_INSTANCE_CL
#include "lib/config.h"
#include "lib/hits.cl"
#include "lib/tables.h"

// The solid `index` in (t_min, hit->t], world-space ray: one ray stands in for all lanes.
static inline void trace_solid(__global const Instance* restrict instances, u32 index, float3 o, float3 d,
                               float t_min, Hit* hit) {
  const REAL3 origins = all3(o), directions = all3(d);
  const REAL starts = (REAL)(t_min);
  Hits hits = no_hits((REAL)(hit->t));
  hits.instance = (MASK)((int)hit->instance);
  hit_solid(instances, index, &origins, &directions, &starts, ALL_LANES, &hits);
  if ((u32)MASK_LANE(hits.instance, 0) == index) *hit = get_hit(&hits, 0);
}
#endif
