// The fields of a scene that has none. The host writes this file anew for a scene with fields.
#pragma once
#include "lib/sdf/sample.h"

static inline REAL sdf_distance(u32 field, REAL3 p, MASK active, __global const float* restrict q) {
  return (REAL)(INFINITY);
}

static inline REAL sdf_signed(u32 field, REAL3 p, MASK active, __global const float* restrict q) {
  return (REAL)(INFINITY);
}

static inline SdfSample sdf_sample(u32 field, REAL3 p, __global const float* restrict q) {
  SdfSample s = {(REAL)(INFINITY), p, (REAL)(0.0f), (REAL)(0.0f), (REAL)(0.0f), (REAL)(0.0f)};
  return s;
}
