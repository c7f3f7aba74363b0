// Real roots of the depressed quartic x^4 + a2 x^2 + a1 x + a0 in an interval, through the extrema of its
// derivatives (Yuksel 2022, "High-Performance Polynomial Root Finding for Graphics"): a polynomial is
// monotone between neighbouring extrema, so every root is bracketed and none is missed, except double roots
// within rounding.
#pragma once
#include "lib/core/config.h"
#include "shared/types.h"

// Coefficients from s[4] (x^4) to s[0] (constant); lower degrees have leading zeros.
static inline float polynomial(const float* c, float x) {
  return fma(fma(fma(fma(c[4], x, c[3]), x, c[2]), x, c[1]), x, c[0]);
}

// Newton steps no longer than this end a search: rounding moves roots as far, and bisection would go far off.
#define ROOT_ERROR 1e-6f

// The root in [low, high], where the polynomial is monotone and changes sign: bisection with Newton steps.
static inline float bracketed_root(const float* c, const float* derivative, float low, float high) {
  const bool rising = polynomial(c, high) > polynomial(c, low);
  float x = 0.5f * (low + high);
#pragma unroll 1
  for (u32 i = 0; i < 40u && low < high; ++i) {
    const float f = polynomial(c, x);
    if ((f > 0.0f) == rising)
      high = x;
    else
      low = x;
    const float slope = polynomial(derivative, x);
    if (fabs(f) <= ROOT_ERROR * fabs(slope)) break;
    const float newton = slope != 0.0f ? x - f / slope : low;
    x = newton > low && newton < high ? newton : 0.5f * (low + high);
  }
  return x;
}

// Replaces `count` ascending extrema, up to MOST_ROOTS, by the first roots between them and the ends; returns
// their number; ascending. A root is written only where the extrema have been read.
#define MOST_ROOTS 4u
static inline u32 extrema_to_roots(const float* c, const float* derivative, float low, float high, u32 count,
                                   float* x) {
  u32 found = 0;
  float left = low, f_left = polynomial(c, low);
#pragma unroll 1
  for (u32 i = 0; i <= count && found < MOST_ROOTS; ++i) {
    const float right = i < count ? clamp(x[i], low, high) : high;
    const float f_right = polynomial(c, right);
    if (f_left == 0.0f && (found == 0u || x[found - 1u] != left))
      x[found++] = left;
    else if ((f_left < 0.0f) != (f_right < 0.0f) && f_right != 0.0f)
      x[found++] = bracketed_root(c, derivative, left, right);
    left = right;
    f_left = f_right;
  }
  if (f_left == 0.0f && found < MOST_ROOTS && (found == 0u || x[found - 1u] != left)) x[found++] = left;
  return found;
}

// `roots` has room for MOST_ROOTS.
static inline u32 quartic_roots(float a2, float a1, float a0, float low, float high, float* roots) {
  const float quartic[5] = {a0, a1, a2, 0.0f, 1.0f}, cubic[5] = {a1, 2.0f * a2, 0.0f, 4.0f, 0.0f},
              quadratic[5] = {2.0f * a2, 0.0f, 12.0f, 0.0f, 0.0f};
  u32 count = 0;
  if (a2 < 0.0f) {
    roots[1] = sqrt(-a2 / 6.0f);
    roots[0] = -roots[1];
    count = 2;
  }
  count = extrema_to_roots(cubic, quadratic, low, high, count, roots);
  return extrema_to_roots(quartic, cubic, low, high, count, roots);
}
