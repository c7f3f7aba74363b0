// Arithmetic of halos: only float additions, products, comparisons and conversions, which every device rounds
// alike, and never fma(), so that a map has the same bits on all devices and on the host, which compiles
// these files in lanes as C++ (host/compile/halo/host_lanes.h replaces lib/core/lanes.h there).
#include "shared/halo.h"

float real_max(float a, float b);
float real_clamp(float a, float low, float high);

static inline float halo_dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// 1 / x for normal x below 1e37, to 2 ulp: an estimate from the exponent (to 12 %), then Newton steps, which
// double its digits.
static inline float halo_inverse(float x) {
  float y = as_float(0x7ef311c7 - as_int(x));
  y = y * (2.0f - x * y);
  y = y * (2.0f - x * y);
  return y * (2.0f - x * y);
}

// 1 / sqrt(x) and sqrt(x) for x >= 0 below 1e37, likewise (the estimate is within 3 %).
static inline float halo_rsqrt(float x) {
  const float half_x = 0.5f * x;
  float y = as_float(0x5f375a86 - (as_int(x) >> 1));
  y = y * (1.5f - half_x * y * y);
  y = y * (1.5f - half_x * y * y);
  return y * (1.5f - half_x * y * y);
}
static inline float halo_sqrt(float x) { return x * halo_rsqrt(x); }

static inline float sign_of(float x) { return x < 0.0f ? -1.0f : 1.0f; }

// Sine and cosine of `turns` (a few at most), by series within an eighth of a turn about zero; 1e-7.
static inline void halo_sincos(float turns, OUT float* sine, OUT float* cosine) {
  const float quarters = 4.0f * turns;
  const int k = (int)(quarters + (quarters < 0.0f ? -0.5f : 0.5f));
  const float x = (quarters - (float)k) * 1.57079633f, z = x * x;
  const float s =
      x * (1.0f + z * (-1.66666667e-1f + z * (8.33333333e-3f + z * (-1.98412698e-4f + z * 2.75573192e-6f))));
  const float c =
      1.0f +
      z * (-0.5f + z * (4.16666667e-2f + z * (-1.38888889e-3f + z * (2.48015873e-5f - z * 2.75573192e-7f))));
  const bool odd = (k & 1) != 0;
  const float upright = odd ? c : s, level = odd ? s : c;
  *sine = (k & 2) != 0 ? -upright : upright;
  *cosine = ((k + 1) & 2) != 0 ? -level : level;
}

// -ln(x) for x in [2^-24, 1]: x = 2^e m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh((m - 1) / (m + 1)).
static inline float halo_minus_log(float x) {
  const int bits = as_int(x) - 0x3f3504f3;
  const float m = as_float((bits & 0x007fffff) + 0x3f3504f3);
  const float y = (m - 1.0f) * halo_inverse(m + 1.0f), z = y * y;
  const float log_m =
      2.0f * y * (1.0f + z * (0.333333333f + z * (0.2f + z * (0.142857143f + z * 0.111111111f))));
  return 0.0f - ((float)(bits >> 23) * 0.693147181f + log_m);
}

// Wellons' lowbias32, a permutation.
static inline u32 halo_hash(u32 x) {
  u32 y = (x ^ (x >> 16)) * 0x7feb352du;
  y = (y ^ (y >> 15)) * 0x846ca68bu;
  return y ^ (y >> 16);
}

// The next of a ray's random numbers in [0, 1), with 24 bits.
static inline float halo_random(OUT u32* state) {
  *state = *state + 0x9e3779b9u;
  return (float)(int)(halo_hash(*state) >> 8) * 5.96046448e-8f;
}
