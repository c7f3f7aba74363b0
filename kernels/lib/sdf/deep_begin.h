// Formulas in double precision, for views so near that floats cannot distinguish the pixels' points. From
// here to lib/sdf/deep_end.h the names of lib/core/lanes.h mean lanes of doubles; on a device without doubles
// they keep their meaning, and such views are coarse.
#pragma once
#include "lib/core/lanes.h"
#include "shared/sdf.h"

#define SDF_DEEP 1
#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable

typedef IN_LANES(double, ) DEEP_REAL;
typedef IN_LANES(long, ) DEEP_MASK;
#define DEEP_MASK_OF(comparison) MASK_BY(long, comparison)
#define DEEP_FROM(x) IN_LANES(convert_double, )(x)
#define DEEP_TO(x) IN_LANES(convert_float, )(x)
#define DEEP_FROM_MASK(x) IN_LANES(convert_long, )(x)
#define DEEP_TO_MASK(x) IN_LANES(convert_int, )(x)

typedef struct DEEP_REAL3 {
  DEEP_REAL x, y, z;
} DEEP_REAL3;

static inline DEEP_REAL3 deep_real3(DEEP_REAL x, DEEP_REAL y, DEEP_REAL z) {
  DEEP_REAL3 r = {x, y, z};
  return r;
}
static inline DEEP_REAL3 deep_negate3(DEEP_REAL3 a) { return deep_real3(-a.x, -a.y, -a.z); }
static inline DEEP_REAL3 deep_scale3(DEEP_REAL3 a, DEEP_REAL s) {
  return deep_real3(a.x * s, a.y * s, a.z * s);
}
static inline DEEP_REAL3 deep_along3(DEEP_REAL3 a, DEEP_REAL s, DEEP_REAL3 b) {
  return deep_real3(fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z));
}
static inline DEEP_REAL deep_dot3(DEEP_REAL3 a, DEEP_REAL3 b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
static inline DEEP_REAL3 deep_select3(DEEP_REAL3 a, DEEP_REAL3 b, DEEP_MASK m) {
  return deep_real3(select(a.x, b.x, m), select(a.y, b.y, m), select(a.z, b.z, m));
}
static inline DEEP_REAL deep_real_min(DEEP_REAL a, DEEP_REAL b) { return select(b, a, DEEP_MASK_OF(a < b)); }
static inline DEEP_REAL deep_real_max(DEEP_REAL a, DEEP_REAL b) { return select(b, a, DEEP_MASK_OF(a > b)); }
static inline DEEP_REAL deep_inverse_root_power(DEEP_REAL x, int n) {
  DEEP_REAL square = 1.0 / sqrt(x), power = (DEEP_REAL)(1.0);
  for (int k = n; k; k >>= 1) {
    if (k & 1) power *= square;
    square *= square;
  }
  return power;
}
static inline DEEP_REAL3 deep_unit3(DEEP_REAL3 a) {
  const DEEP_REAL square = deep_dot3(a, a);
  const DEEP_MASK good = DEEP_MASK_OF(square > 0.0) & DEEP_MASK_OF(square < 1e300);
  const DEEP_REAL inverse = 1.0 / sqrt(select((DEEP_REAL)(1.0), square, good));
  return deep_select3(deep_real3((DEEP_REAL)(1.0), (DEEP_REAL)(0.0), (DEEP_REAL)(0.0)),
                      deep_scale3(a, inverse), good);
}
static inline int deep_any_lane(DEEP_MASK m) { return any_lane(DEEP_TO_MASK(m)); }

// The parameters' doubles follow their floats.
#define DEEP_TABLE(q) ((__global const double*)((q) + SDF_DOUBLES_AT))
#define SDF_TABLE __global const double* restrict
#define SCALAR double
#define LITERAL(x) x
#define REAL DEEP_REAL
#define REAL3 DEEP_REAL3
#define MASK DEEP_MASK
#undef MASK_OF
#define MASK_OF DEEP_MASK_OF
#define real3 deep_real3
#define negate3 deep_negate3
#define scale3 deep_scale3
#define along3 deep_along3
#define dot3 deep_dot3
#define select3 deep_select3
#define unit3 deep_unit3
#define real_min deep_real_min
#define real_max deep_real_max
#define real_sqrt sqrt
#define real_log log
#define real_sin sin
#define real_cos cos
#define rough_rsqrt(x) (1.0 / sqrt(x))
#define rough_inverse(x) (1.0 / (x))
#define inverse_root_power deep_inverse_root_power
#define any_lane deep_any_lane

#else
#define DEEP_REAL REAL
#define DEEP_REAL3 REAL3
#define DEEP_MASK MASK
#define DEEP_FROM(x) (x)
#define DEEP_TO(x) (x)
#define DEEP_FROM_MASK(x) (x)
#define DEEP_TABLE(q) (q)
#endif

#define SdfSample DeepSample
