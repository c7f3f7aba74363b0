// What generated code returns about a point of a field, and how it is called.
#ifndef SUNDOG_LIB_SDF_SAMPLE_H
#define SUNDOG_LIB_SDF_SAMPLE_H
#include "lib/lanes.h"
#include "shared/sdf.h"

#define SDF_PARAMETERS \
  __global const SdfField *restrict sdf_fields, __global const float *restrict sdf_parameters
#define SDF_ARGUMENTS sdf_fields, sdf_parameters

// A distance with its gradient (of any length: only its direction is meant) and the orbit's traps.
typedef struct SdfSample {
  REAL distance;
  REAL3 gradient;
  REAL point, plane, axis;  // least distances of the orbit from the origin, the planes and the axes
  REAL iterations;          // until escape, continuous
} SdfSample;

// Square of a quaternion's or a triplex number's length, in the order that every formula uses.
static inline REAL square_length3(REAL x, REAL y, REAL z) { return fma(x, x, fma(y, y, z * z)); }
static inline REAL square_length4(REAL x, REAL y, REAL z, REAL w) {
  return fma(x, x, fma(y, y, fma(z, z, w * w)));
}

static inline SdfSample no_sample(void) {
  const REAL zero = (REAL)(0.0f);
  const SdfSample s = {(REAL)(1e20f), {zero, zero, zero}, zero, zero, zero, zero};
  return s;
}

// Distance of a point from the nearest coordinate axis.
static inline REAL axis_distance(REAL x, REAL y, REAL z) {
  const REAL xx = x * x, yy = y * y, zz = z * z;
  return sqrt(real_min(xx + yy, real_min(yy + zz, xx + zz)));
}

// A formula that gives no number there counts as empty: the march goes on by a small step.
static inline REAL finite_distance(REAL d) { return select((REAL)(1e-3f), d, MASK_OF(fabs(d) < 1e30f)); }

static inline SdfSample select_sample(SdfSample a, SdfSample b, MASK m) {
  SdfSample r;
  r.distance = select(a.distance, b.distance, m);
  r.gradient = select3(a.gradient, b.gradient, m);
  r.point = select(a.point, b.point, m);
  r.plane = select(a.plane, b.plane, m);
  r.axis = select(a.axis, b.axis, m);
  r.iterations = select(a.iterations, b.iterations, m);
  return r;
}

#endif
