// Directions about an axis and points in a disk, one per lane.
#pragma once
#include "lib/core/lanes.h"

// Sine and cosine of a fraction `turn` of a circle, both to 1.2e-7 (polynomials at Chebyshev nodes). Unlike
// the library's, they have the same bits on every device.
static inline void sincos_of_turn(REAL turn, REAL* sine, REAL* cosine) {
  const REAL quarters = 4.0f * turn, nearest = rint(quarters);
  const REAL x = quarters - nearest, z = x * x;
  REAL s = fma(z, (REAL)(-0.0046021631f), (REAL)(0.0796802229f));
  s = x * fma(z, fma(z, s, (REAL)(-0.645963478f)), (REAL)(1.57079632f));
  REAL c = fma(z, (REAL)(0.000903975442f), (REAL)(-0.0208602648f));
  c = fma(z, fma(z, fma(z, c, (REAL)(0.25366924f)), (REAL)(-1.23370054f)), (REAL)(1.0f));
  const MASK quarter = TO_MASK(nearest), odd = MASK_OF((quarter & 1) != 0);
  *sine = AS_REAL(AS_MASK(select(s, c, odd)) ^ ((quarter & 2) << 30));
  *cosine = AS_REAL(AS_MASK(select(c, s, odd)) ^ (((quarter + 1) & 2) << 30));
}

// The arc cosine of x in [-1, 1], to 3e-7, from the smaller of x and the sine of the half angle.
static inline REAL real_acos(REAL x) {
  const REAL size = fabs(x);
  const MASK steep = MASK_OF(size > 0.5f);
  const REAL z = select(size * size, fma(size, (REAL)(-0.5f), (REAL)(0.5f)), steep);
  const REAL s = select(size, real_sqrt(z), steep);
  REAL p = fma(z, (REAL)(0.0421473649f), (REAL)(0.0241886496f));
  p = fma(z, fma(z, fma(z, p, (REAL)(0.0454691882f)), (REAL)(0.0749529794f)), (REAL)(0.166667529f));
  p = fma(s * z, p, s);
  const REAL angle = select(0.5f * M_PI_F - p, 2.0f * p, steep);
  return select(angle, M_PI_F - angle, MASK_OF(x < 0.0f));
}

// Completes the unit vector n to an orthonormal basis (Duff and others 2017, "Building an Orthonormal Basis,
// Revisited").
static inline void tangent_frame(REAL3 n, REAL3* s, REAL3* t) {
  const REAL sign = copysign((REAL)(1.0f), n.z);
  const REAL a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  *s = real3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  *t = real3(b, sign + n.y * n.y * a, -n.y);
}

// The direction with this cosine and sine to the unit axis, at the azimuth `turn` (fraction of a circle).
static inline REAL3 direction_at(REAL3 axis, REAL cosine, REAL sine, REAL turn) {
  REAL3 s, t;
  REAL across, along;
  tangent_frame(axis, &s, &t);
  sincos_of_turn(turn, &across, &along);
  return add3(scale3(axis, cosine), add3(scale3(s, sine * along), scale3(t, sine * across)));
}

// direction_at() with the cosine only.
static inline REAL3 direction_about(REAL3 axis, REAL c, REAL turn) {
  return direction_at(axis, c, real_sqrt(real_max(1.0f - c * c, (REAL)(0.0f))), turn);
}

// A uniformly distributed point of the unit disk (Shirley and Chiu 1997, "A Low Distortion Map Between Disk
// and Square").
static inline void place_in_disk(REAL u_x, REAL u_y, REAL* x, REAL* y) {
  const REAL a = fma(u_x, (REAL)(2.0f), (REAL)(-1.0f)), b = fma(u_y, (REAL)(2.0f), (REAL)(-1.0f));
  const MASK wide = MASK_OF(fabs(a) > fabs(b));
  const REAL r = select(b, a, wide), part = select(a, b, wide) / nonzero(r) * 0.125f;
  REAL sine, cosine;
  sincos_of_turn(select(0.25f - part, part, wide), &sine, &cosine);
  *x = r * cosine;
  *y = r * sine;
}
