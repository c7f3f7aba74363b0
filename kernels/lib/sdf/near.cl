// The generated fields, with a default for scenes without uneven fields: estimates that are distances
// everywhere need no separate distance near the surface.
#pragma once
#include "generated/sdf.cl"

#ifndef SDF_HAS_NEAR
#define SDF_HAS_NEAR 0
// Whether the estimate is only a fraction of the distance, which sdf_near() gives near the surface.
static inline bool sdf_uneven(u32 field, __global const float* restrict q) { return false; }
static inline REAL sdf_near(u32 field, REAL3 p, MASK active, __global const float* restrict q) {
  return sdf_distance(field, p, active, q);
}
#endif
