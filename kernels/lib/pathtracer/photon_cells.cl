// The cubes that photons are found by.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/sampler.cl"
#include "shared/photons.h"

// Where things move, light that is seen at one time has come at that time: photons lie in slices of the time
// for which the shutter is open, each of which stands for the whole.
#define PHOTON_SLICES EITHER(HAS_OBJECT_MOTION, 16u, 1u)
static inline u32 photon_slice(float time) {
  return min((u32)(time * (float)PHOTON_SLICES), PHOTON_SLICES - 1u);
}

// The cells of cubes in a row along x follow each other.
static inline int3 photon_cube(float3 p, float inverse_edge) {
  return convert_int3_sat_rtn(p * inverse_edge);
}
static inline u32 photon_cell(int3 cube, u32 slice) {
  const u32 row = (u32)cube.y * 19349663u ^ (u32)cube.z * 83492791u;
  return hash_u32(row + slice * 0x9e3779b9u) + (u32)cube.x;
}

// A number in [-1, 1] with a whole number in the same float, and the whole number again.
static inline float with_count(float value, u32 count) { return value + 4.0f * (float)count; }
static inline REAL counts_of(REAL packed) { return floor((packed + 2.0f) * 0.25f); }
static inline REAL without_counts(REAL packed) { return packed - 4.0f * counts_of(packed); }

// A unit direction as two numbers in [-1, 1]: the octahedron unfolded (Cigolle and others 2014, "A Survey of
// Efficient Representations for Independent Unit Vectors").
static inline float2 fold_corners(float2 v) { return (1.0f - fabs(v.yx)) * copysign((float2)(1.0f), v); }
static inline float2 pack_direction(float3 d) {
  const float2 v = d.xy / (fabs(d.x) + fabs(d.y) + fabs(d.z));
  return d.z < 0.0f ? fold_corners(v) : v;
}
static inline REAL3 unpack_directions(REAL u, REAL v) {
  const REAL z = 1.0f - fabs(u) - fabs(v);
  const MASK folded = MASK_OF(z < 0.0f);
  const REAL3 d = real3(select(u, (1.0f - fabs(v)) * copysign((REAL)(1.0f), u), folded),
                        select(v, (1.0f - fabs(u)) * copysign((REAL)(1.0f), v), folded), z);
  return renormalized3(d);
}
