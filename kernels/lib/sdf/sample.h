// Results of generated code at a point of a field, and their helpers.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

// Types of a formula's table and of its scalars: doubles in deep views (deep_begin.h).
#ifndef SDF_TABLE
#define SDF_TABLE __global const float* restrict
#define SCALAR float
#define LITERAL(x) x##f
#endif

// A distance with its gradient (for fractals only a direction, of any length) and the orbit's traps.
typedef struct SdfSample {
  REAL distance;
  REAL3 gradient;
  REAL point, plane, axis;  // minimum distances of the orbit from the origin, the planes and the axes
  REAL iterations;          // until escape, continuous
} SdfSample;

// Squared length of a quaternion or triplex number, with the same order of operations in every formula.
static inline REAL square_length3(REAL x, REAL y, REAL z) { return fma(z, z, fma(x, x, y * y)); }
static inline REAL square_length4(REAL x, REAL y, REAL z, REAL w) {
  return fma(x, x, fma(y, y, fma(z, z, w * w)));
}

// Distance to a set from the squared length of an orbit's last point and its derivative: half of the
// logarithmic form if the map is a power, else the plain quotient. An orbit stopped by the iteration limit is
// near the surface |z| = bailout of the last iteration, or inside: `level`, the logarithm of the squared
// bailout or the bailout, gives the distance to that surface, slightly negative inside. For others it is 0.
// If the length is finite but the derivative overflowed, the surface is extremely close: growth_of().
static inline REAL growth_of(REAL square, REAL derivative) {
  const MASK lost = MASK_OF(square < INFINITY) & ~MASK_OF(derivative < 1e37f);
  return real_max(select(derivative, (REAL)(1e37f), lost), (REAL)(1e-30f));
}
static inline REAL logarithmic_distance(REAL square, REAL derivative, REAL level) {
  const REAL r2 = real_max(real_min(square, (REAL)(1e36f)), (REAL)(1e-30f));
  const REAL d =
      0.25f * (real_log(r2) - level) * (r2 * rough_rsqrt(r2)) * rough_inverse(growth_of(square, derivative));
  return fmax(d, (REAL)(-1e-3f));
}
static inline REAL linear_distance(REAL square, REAL derivative, REAL level) {
  const REAL d =
      (real_sqrt(real_min(square, (REAL)(1e36f))) - level) * rough_inverse(growth_of(square, derivative));
  return fmax(d, (REAL)(-1e-3f));
}

static inline SdfSample no_sample(void) {
  const REAL zero = (REAL)(0.0f);
  const SdfSample s = {(REAL)(1e20f), {zero, zero, zero}, zero, zero, zero, zero};
  return s;
}

// The largest stretch of a Jacobian J, overestimated by at most 15 %: the largest eigenvalue of A = J^T J is
// m + 2 p cos(x), with the mean m of the eigenvalues and their spread p (O. Smith, Eigenvalues of a symmetric
// 3 x 3 matrix, 1961); here cos(x) = 1. Exact if J is conformal.
static inline REAL greatest_part(REAL3 a) { return real_max(fabs(a.x), real_max(fabs(a.y), fabs(a.z))); }
static inline REAL stretch_of(REAL3 j0, REAL3 j1, REAL3 j2,
                              REAL3 j3) {  // rows of J; the fourth is zero in space
  const REAL size = real_max(real_max(greatest_part(j0), greatest_part(j1)),
                             real_max(real_max(greatest_part(j2), greatest_part(j3)), (REAL)(1e-30f)));
  const REAL k = 1.0f / size;  // avoids overflow of the entries' fourth powers
  const REAL3 a = scale3(j0, k), b = scale3(j1, k), c = scale3(j2, k), d = scale3(j3, k);
  const REAL xx = fma(a.x, a.x, fma(b.x, b.x, fma(c.x, c.x, d.x * d.x)));
  const REAL yy = fma(a.y, a.y, fma(b.y, b.y, fma(c.y, c.y, d.y * d.y)));
  const REAL zz = fma(a.z, a.z, fma(b.z, b.z, fma(c.z, c.z, d.z * d.z)));
  const REAL xy = fma(a.x, a.y, fma(b.x, b.y, fma(c.x, c.y, d.x * d.y)));
  const REAL yz = fma(a.y, a.z, fma(b.y, b.z, fma(c.y, c.z, d.y * d.z)));
  const REAL zx = fma(a.z, a.x, fma(b.z, b.x, fma(c.z, c.x, d.z * d.x)));
  const REAL mean = (xx + yy + zz) * (1.0f / 3.0f);
  const REAL off = fma(xy, xy, fma(yz, yz, zx * zx));
  const REAL u = xx - mean, v = yy - mean, w = zz - mean;
  const REAL spread = fma(u, u, fma(v, v, fma(w, w, 2.0f * off))) * (1.0f / 6.0f);
  return size * real_sqrt(mean + 2.0f * real_sqrt(spread));
}

// Distance to the nearest coordinate axis.
static inline REAL axis_distance(REAL x, REAL y, REAL z) {
  const REAL xx = x * x, yy = y * y, zz = z * z;
  return real_sqrt(real_min(xx + yy, real_min(yy + zz, xx + zz)));
}

// NaN counts as empty: the march advances by a small step.
static inline REAL finite_distance(REAL d) { return select((REAL)(1e-3f), d, MASK_OF(fabs(d) < 1e30f)); }

// Distance to the surface, to first order, whatever the scale of the estimate.
static inline REAL near_distance(SdfSample s) {
  return finite_distance(s.distance / real_sqrt(real_max(dot3(s.gradient, s.gradient), (REAL)(1e-30f))));
}

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
