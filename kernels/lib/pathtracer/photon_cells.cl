// The cubes that photons are found by.
#ifndef SUNDOG_LIB_PHOTON_CELLS_CL
#define SUNDOG_LIB_PHOTON_CELLS_CL
#include "lib/core/sampler.cl"
#include "shared/photons.h"

static inline int3 photon_cube(float3 p, float inverse_edge) {
  return convert_int3_sat_rtn(p * inverse_edge);
}
static inline u32 photon_cell(int3 cube) {
  return hash_u32((u32)cube.x + hash_u32((u32)cube.y + hash_u32((u32)cube.z)));
}

// A unit direction as two numbers in [-1, 1]: the octahedron unfolded (Cigolle and others 2014, "A Survey of
// Efficient Representations for Independent Unit Vectors").
static inline float2 fold_corners(float2 v) { return (1.0f - fabs(v.yx)) * copysign((float2)(1.0f), v); }
static inline float2 pack_direction(float3 d) {
  const float2 v = d.xy / (fabs(d.x) + fabs(d.y) + fabs(d.z));
  return d.z < 0.0f ? fold_corners(v) : v;
}
static inline float3 unpack_direction(float2 v) {
  const float z = 1.0f - fabs(v.x) - fabs(v.y);
  const float2 side = z < 0.0f ? fold_corners(v) : v;
  const float3 d = (float3)(side.x, side.y, z);
  return d * rsqrt(dot(d, d));
}

#endif
