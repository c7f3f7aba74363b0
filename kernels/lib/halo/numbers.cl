// Arithmetic of halos: only float additions, products, comparisons and conversions, which every device rounds
// alike, and never fma(), so that a map has the same bits on all devices and on the host, which compiles
// these files as C++ (host/compile/halo/host_lanes.h replaces lib/core/lanes.h there).
#pragma once
#include "shared/halo.h"
#ifndef SUNDOG_HOST_LANES
#include "lib/core/lanes.h"
#define ALL_OF(x) ((REAL)(x))
#endif

ALWAYS_INLINE REAL halo_dot(REAL3 a, REAL3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// 1 / x for normal x below 1e37, to 2 ulp: an estimate from the exponent (to 12 %), then Newton steps, which
// double its digits.
ALWAYS_INLINE REAL halo_inverse(REAL x) {
  REAL y = AS_REAL(0x7ef311c7 - AS_MASK(x));
  y = y * (2.0f - x * y);
  y = y * (2.0f - x * y);
  return y * (2.0f - x * y);
}

// sqrt(x) for x >= 0 below 1e37, through 1 / sqrt(x) likewise (the estimate is within 3 %).
ALWAYS_INLINE REAL halo_inverse_root(REAL x) {
  const REAL half_x = 0.5f * x;
  REAL y = AS_REAL(0x5f375a86 - (AS_MASK(x) >> 1));
  y = y * (1.5f - half_x * y * y);
  y = y * (1.5f - half_x * y * y);
  return y * (1.5f - half_x * y * y);
}
ALWAYS_INLINE REAL halo_root(REAL x) { return x * halo_inverse_root(x); }

// Sine and cosine of `turns` (a few at most), by series within an eighth of a turn about zero; 1e-7.
ALWAYS_INLINE void halo_turn(REAL turns, REAL* sine, REAL* cosine) {
  const REAL quarters = 4.0f * turns;
  const MASK k = TO_MASK(quarters + select(ALL_OF(0.5f), ALL_OF(-0.5f), MASK_OF(quarters < 0.0f)));
  const REAL x = (quarters - TO_REAL(k)) * 1.57079633f, z = x * x;
  const REAL s =
      x * (1.0f + z * (-1.66666667e-1f + z * (8.33333333e-3f + z * (-1.98412698e-4f + z * 2.75573192e-6f))));
  const REAL c =
      1.0f +
      z * (-0.5f + z * (4.16666667e-2f + z * (-1.38888889e-3f + z * (2.48015873e-5f - z * 2.75573192e-7f))));
  const MASK odd = MASK_OF((k & 1) != 0);
  const REAL upright = select(s, c, odd), level = select(c, s, odd);
  *sine = select(upright, -upright, MASK_OF((k & 2) != 0));
  *cosine = select(level, -level, MASK_OF(((k + 1) & 2) != 0));
}

// -ln(x) for x in [2^-24, 1]: x = 2^e m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh((m - 1) / (m + 1)).
ALWAYS_INLINE REAL halo_minus_log(REAL x) {
  const MASK bits = AS_MASK(x) - 0x3f3504f3;
  const REAL m = AS_REAL((bits & 0x007fffff) + 0x3f3504f3);
  const REAL y = (m - 1.0f) * halo_inverse(m + 1.0f), z = y * y;
  const REAL log_m =
      2.0f * y * (1.0f + z * (0.333333333f + z * (0.2f + z * (0.142857143f + z * 0.111111111f))));
  return 0.0f - (TO_REAL(bits >> 23) * 0.693147181f + log_m);
}

// Wellons' lowbias32, a permutation.
ALWAYS_INLINE UINTS halo_hash(UINTS x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

// The next of a ray's random numbers in [0, 1), with 24 bits.
ALWAYS_INLINE REAL halo_random(UINTS* state) {
  *state = *state + 0x9e3779b9u;
  return TO_REAL(AS_MASK(halo_hash(*state) >> 8)) * 5.96046448e-8f;
}
