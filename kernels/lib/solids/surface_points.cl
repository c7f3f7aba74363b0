// Coordinates on surfaces of revolution and other shared functions, one point per lane.
#pragma once
#include "lib/core/config.h"
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

// Coordinates on a surface in object space (shade/parametrize.cl): u and v, and the point's derivatives.
typedef struct SurfacePoints {
  REAL u, v;
  REAL3 dpdu, dpdv;
} SurfacePoints;

// The angle of (x, y) in turns, [0, 1): an odd polynomial at Chebyshev nodes (error 1e-8 turns) of the
// smaller over the larger coordinate, with the same bits on every device.
static inline REAL turns(REAL x, REAL y) {
  const REAL ax = fabs(x), ay = fabs(y), most = real_max(ax, ay);
  const REAL t = real_min(ax, ay) / select(most, (REAL)(1.0f), MASK_OF(most == 0.0f)), z = t * t;
  REAL p = fma(z, (REAL)(0.0027662835f), (REAL)(-0.0157312491f));
  p = fma(z, p, (REAL)(0.0421376236f));
  p = fma(z, p, (REAL)(-0.0745685483f));
  p = fma(z, p, (REAL)(0.106183706f));
  p = fma(z, p, (REAL)(-0.141977978f));
  p = fma(z, p, (REAL)(0.19991872f));
  p = fma(z, p, (REAL)(-0.333330367f));
  p = fma(z, p, (REAL)(0.999999982f));
  REAL turn = p * t * (0.5f / M_PI_F);
  turn = select(turn, 0.25f - turn, MASK_OF(ay > ax));
  turn = select(turn, 0.5f - turn, MASK_OF(x < 0.0f));
  return select(turn, real_min(1.0f - turn, (REAL)(0x1.fffffep-1f)), MASK_OF(y < 0.0f));
}
// Derivative of points by longitude, which turns from +x to -z.
static inline REAL3 round_tangents(REAL3 p) {
  return scale3(real3(p.z, (REAL)(0.0f), -p.x), (REAL)(2.0f * M_PI_F));
}
static inline REAL radius_about_y(REAL3 p) { return real_sqrt(fma(p.x, p.x, p.z * p.z)); }

// Unit directions away from the y axis; arbitrary on the axis.
static inline REAL3 away_from_axis(REAL3 p, REAL r) {
  const MASK off = MASK_OF(r > 0.0f);
  const REAL inverse = 1.0f / select((REAL)(1.0f), r, off);
  return real3(select((REAL)(1.0f), p.x * inverse, off), (REAL)(0.0f),
               select((REAL)(0.0f), p.z * inverse, off));
}

static inline SurfacePoints select_points(SurfacePoints a, SurfacePoints b, MASK m) {
  const SurfacePoints at = {select(a.u, b.u, m), select(a.v, b.v, m), select3(a.dpdu, b.dpdu, m),
                            select3(a.dpdv, b.dpdv, m)};
  return at;
}
