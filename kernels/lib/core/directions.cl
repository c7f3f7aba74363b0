// Directions about an axis and points in a disk. A lane each.
#ifndef SUNDOG_LIB_DIRECTIONS_CL
#define SUNDOG_LIB_DIRECTIONS_CL
#include "lib/core/lanes.h"

// Two vectors at right angles to the unit vector n and to each other (Duff and others 2017, "Building an
// Orthonormal Basis, Revisited").
static inline void tangent_frame(REAL3 n, REAL3* s, REAL3* t) {
  const REAL sign = copysign((REAL)(1.0f), n.z);
  const REAL a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  *s = real3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  *t = real3(b, sign + n.y * n.y * a, -n.y);
}

// The direction at the cosine and sine to the unit axis, turned about it by the share `turn` of a circle.
static inline REAL3 direction_at(REAL3 axis, REAL cosine, REAL sine, REAL turn) {
  REAL3 s, t;
  tangent_frame(axis, &s, &t);
  const REAL angle = 2.0f * M_PI_F * turn;
  return add3(scale3(axis, cosine), add3(scale3(s, sine * cos(angle)), scale3(t, sine * sin(angle))));
}

// The same by the cosine alone.
static inline REAL3 direction_about(REAL3 axis, REAL c, REAL turn) {
  return direction_at(axis, c, real_sqrt(real_max(1.0f - c * c, (REAL)(0.0f))), turn);
}

// A point of the unit disk, uniform in area (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and
// Square").
static inline void place_in_disk(REAL u_x, REAL u_y, REAL* x, REAL* y) {
  const REAL a = fma(u_x, (REAL)(2.0f), (REAL)(-1.0f)), b = fma(u_y, (REAL)(2.0f), (REAL)(-1.0f));
  const MASK wide = MASK_OF(fabs(a) > fabs(b));
  const REAL r = select(b, a, wide), part = select(a, b, wide) / nonzero(r) * (0.25f * M_PI_F);
  const REAL angle = select(0.5f * M_PI_F - part, part, wide);
  *x = r * cos(angle);
  *y = r * sin(angle);
}

#endif
