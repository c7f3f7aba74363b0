// A solid's instance against a ray in the instance's space.
#ifndef SUNDOG_LIB_SOLID_INSTANCE_CL
#define SUNDOG_LIB_SOLID_INSTANCE_CL
#include "lib/config.h"
#include "lib/solids.cl"
#include "lib/tables.h"
#include "lib/transform.cl"

// Takes the solid's nearest hit in (t_min, hit->t] as *hit; of equal t, the lower instance's.
static inline void trace_solid(__global const Instance* restrict instances, u32 index, float3 o, float3 d,
                               float t_min, Hit* hit) {
  __global const Instance* instance = instances + index;
  SolidHit solid;
  if (!closest_in_solid(instance->shape, instance->parameters, o, d, t_min, hit->t, &solid)) return;
  if (solid.t == hit->t && hit->instance <= index) return;
  hit->t = solid.t;
  hit->u = 0.0f;
  hit->v = 0.0f;
  hit->prim = solid.part;
  hit->instance = index;
  hit->ng_x = solid.ng.x;
  hit->ng_y = solid.ng.y;
  hit->ng_z = solid.ng.z;
}

#endif
