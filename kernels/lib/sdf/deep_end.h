// Ends lib/sdf/deep_begin.h.
#pragma once

#undef SdfSample
#ifdef cl_khr_fp64
#undef REAL
#undef REAL3
#undef MASK
#undef MASK_OF
#define MASK_OF(comparison) MASK_BY(int, comparison)
#undef real3
#undef negate3
#undef scale3
#undef along3
#undef dot3
#undef select3
#undef unit3
#undef real_min
#undef real_max
#undef real_sqrt
#undef real_log
#undef real_sin
#undef real_cos
#undef rough_rsqrt
#undef rough_inverse
#undef inverse_root_power
#undef any_lane
#endif

typedef struct SdfSample {
  REAL distance;
  REAL3 gradient;
  REAL point, plane, axis, iterations;
} SdfSample;

// Converts from the rays' frame to field space; the frame's origin is at `origin` in the table.
static inline DEEP_REAL3 deep_place(REAL3 p, __global const float* restrict q, u32 origin) {
  const DEEP_REAL3 place = {DEEP_FROM(p.x) + DEEP_TABLE(q)[origin],
                            DEEP_FROM(p.y) + DEEP_TABLE(q)[origin + 1u],
                            DEEP_FROM(p.z) + DEEP_TABLE(q)[origin + 2u]};
  return place;
}

static inline SdfSample shallow_sample(DeepSample s) {
  const SdfSample r = {
      DEEP_TO(s.distance), {DEEP_TO(s.gradient.x), DEEP_TO(s.gradient.y), DEEP_TO(s.gradient.z)},
      DEEP_TO(s.point),    DEEP_TO(s.plane),
      DEEP_TO(s.axis),     DEEP_TO(s.iterations)};
  return r;
}
