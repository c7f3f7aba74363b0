// Rays and normals between world and object space.
#ifndef SUNDOG_LIB_TRANSFORM_CL
#define SUNDOG_LIB_TRANSFORM_CL
#include "lib/config.h"
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

// A normal is a covector: it goes to world space by the transpose of object_from_world. Not normalised.
static inline float3 world_normal(__global const Instance* instance, float3 n) {
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return (float3)(fma(r0.x, n.x, fma(r1.x, n.y, r2.x * n.z)), fma(r0.y, n.x, fma(r1.y, n.y, r2.y * n.z)),
                  fma(r0.z, n.x, fma(r1.z, n.y, r2.z * n.z)));
}

// For a vector of moderate length, such as a sum of unit vectors: quicker than unit().
static inline float3 renormalized(float3 v) { return v * (1.0f / sqrt(dot(v, v))); }

// Normalises without overflow or underflow of the squared length: a scene may be in nanometres or light
// years.
static inline float3 unit(float3 v) {
  const float scale = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
  if (!(scale > 0.0f) || isinf(scale)) return v;
  const float3 w = v / scale;
  return w / sqrt(dot(w, w));
}

#endif
