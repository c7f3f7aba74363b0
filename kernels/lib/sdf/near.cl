// The generated fields, where a scene's host may leave out a question: fields whose estimates are distances
// everywhere have no other distance near their surfaces.
#ifndef SUNDOG_LIB_SDF_NEAR_CL
#define SUNDOG_LIB_SDF_NEAR_CL
#include "generated/sdf.cl"

#ifndef SDF_HAS_NEAR
#define SDF_HAS_NEAR 0
// Whether the field's estimate is only a part of the distance, which sdf_near() then tells near the surface.
static inline bool sdf_uneven(u32 field, __global const float* restrict q) { return false; }
static inline REAL sdf_near(u32 field, REAL3 p, MASK active, __global const float* restrict q) {
  return sdf_distance(field, p, active, q);
}
#endif

#endif
