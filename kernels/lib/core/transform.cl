// Rays and normals between world and object space.
#pragma once
#include "lib/core/lanes.h"
#include "shared/bvh.h"

static inline float3 object_point(__global const Instance* instance, float3 p) {
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return (float3)(fma(r0.x, p.x, fma(r0.y, p.y, fma(r0.z, p.z, r0.w))),
                  fma(r1.x, p.x, fma(r1.y, p.y, fma(r1.z, p.z, r1.w))),
                  fma(r2.x, p.x, fma(r2.y, p.y, fma(r2.z, p.z, r2.w))));
}

static inline float3 object_vector(__global const Instance* instance, float3 d) {
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return (float3)(fma(r0.x, d.x, fma(r0.y, d.y, r0.z * d.z)), fma(r1.x, d.x, fma(r1.y, d.y, r1.z * d.z)),
                  fma(r2.x, d.x, fma(r2.y, d.y, r2.z * d.z)));
}

// For points, one ray per lane.
static inline REAL3 object_points(__global const Instance* instance, REAL3 p) {
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return real3(fma((REAL)(r0.x), p.x, fma((REAL)(r0.y), p.y, fma((REAL)(r0.z), p.z, (REAL)(r0.w)))),
               fma((REAL)(r1.x), p.x, fma((REAL)(r1.y), p.y, fma((REAL)(r1.z), p.z, (REAL)(r1.w)))),
               fma((REAL)(r2.x), p.x, fma((REAL)(r2.y), p.y, fma((REAL)(r2.z), p.z, (REAL)(r2.w)))));
}

static inline REAL3 object_vectors(__global const Instance* instance, REAL3 d) {
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return real3(fma((REAL)(r0.x), d.x, fma((REAL)(r0.y), d.y, r0.z * d.z)),
               fma((REAL)(r1.x), d.x, fma((REAL)(r1.y), d.y, r1.z * d.z)),
               fma((REAL)(r2.x), d.x, fma((REAL)(r2.y), d.y, r2.z * d.z)));
}

// Transforms rays to object space; instances that only scale and move, as many solids do, take a third of the
// products for the same bits.
static inline void into_object(__global const Instance* instance, REAL3* o, REAL3* d) {
  if (instance->flags & INSTANCE_IDENTITY) return;
  if (!(instance->flags & INSTANCE_SCALES)) {
    *o = object_points(instance, *o);
    *d = object_vectors(instance, *d);
    return;
  }
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  *o = real3(fma((REAL)(r0.x), o->x, (REAL)(r0.w)), fma((REAL)(r1.y), o->y, (REAL)(r1.w)),
             fma((REAL)(r2.z), o->z, (REAL)(r2.w)));
  *d = real3(r0.x * d->x, r1.y * d->y, r2.z * d->z);
}

// Normals are covectors, so the transpose of object_from_world takes them to world space. Not normalised.
static inline REAL3 world_normals(__global const Instance* instance, REAL3 n) {
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return real3(fma((REAL)(r0.x), n.x, fma((REAL)(r1.x), n.y, r2.x * n.z)),
               fma((REAL)(r0.y), n.x, fma((REAL)(r1.y), n.y, r2.y * n.z)),
               fma((REAL)(r0.z), n.x, fma((REAL)(r1.z), n.y, r2.z * n.z)));
}

static inline float3 world_normal(__global const Instance* instance, float3 n) {
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return (float3)(fma(r0.x, n.x, fma(r1.x, n.y, r2.x * n.z)), fma(r0.y, n.x, fma(r1.y, n.y, r2.y * n.z)),
                  fma(r0.z, n.x, fma(r1.z, n.y, r2.z * n.z)));
}
