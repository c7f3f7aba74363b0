// One source for every number of lanes: REAL is a float or a vector of LANES floats, MASK an int or a vector
// of ints whose lanes are 0 or -1 (all bits set) for scalars too, so that select(), any() and the bit
// operators mean the same for LANES = 1, 4, 8 and 16. Comparisons go through MASK_OF(a < b). Everything here
// gives the same bits for every number of lanes. Included once a program: LANES is a definition of the whole
// build.
#ifndef SUNDOG_LIB_LANES_H
#define SUNDOG_LIB_LANES_H
#include "lib/config.h"

#ifndef LANES
#define LANES BATCH
#endif

#if LANES == 1
typedef float REAL;
typedef int MASK;
#define MASK_OF(comparison) (-(int)(comparison))
#define AS_MASK(x) as_int(x)
#define AS_REAL(x) as_float(x)
#define TO_MASK(x) convert_int_rtz(x)
#define TO_REAL(x) convert_float(x)
#elif LANES == 4
typedef float4 REAL;
typedef int4 MASK;
#define MASK_OF(comparison) (comparison)
#define AS_MASK(x) as_int4(x)
#define AS_REAL(x) as_float4(x)
#define TO_MASK(x) convert_int4_rtz(x)
#define TO_REAL(x) convert_float4(x)
#elif LANES == 8
typedef float8 REAL;
typedef int8 MASK;
#define MASK_OF(comparison) (comparison)
#define AS_MASK(x) as_int8(x)
#define AS_REAL(x) as_float8(x)
#define TO_MASK(x) convert_int8_rtz(x)
#define TO_REAL(x) convert_float8(x)
#elif LANES == 16
typedef float16 REAL;
typedef int16 MASK;
#define MASK_OF(comparison) (comparison)
#define AS_MASK(x) as_int16(x)
#define AS_REAL(x) as_float16(x)
#define TO_MASK(x) convert_int16_rtz(x)
#define TO_REAL(x) convert_float16(x)
#else
#error "LANES must be 1, 4, 8 or 16"
#endif

#define NO_LANES ((MASK)(0))
#define ALL_LANES ((MASK)(-1))

// True when some lane of the mask is set: one instruction where there is one; OpenCL's any() is a chain of
// branches in PoCL.
static inline int any_lane(MASK m) {
#if LANES == 1
  return m;
#elif LANES == 16 && defined(__AVX512DQ__) && !defined(SUNDOG_PORTABLE)
  return __builtin_ia32_cvtd2mask512(m) != 0;
#elif LANES == 8 && defined(__AVX__) && !defined(SUNDOG_PORTABLE)
  return __builtin_ia32_movmskps256(as_float8(m)) != 0;
#elif LANES == 4 && defined(__SSE__) && !defined(SUNDOG_PORTABLE)
  return __builtin_ia32_movmskps(as_float4(m)) != 0;
#else
#if LANES == 16
  const int8 eight = m.lo | m.hi;
#elif LANES == 8
  const int8 eight = m;
#endif
#if LANES == 4
  const int4 four = m;
#else
  const int4 four = eight.lo | eight.hi;
#endif
  const int2 two = four.lo | four.hi;
  return two.x | two.y;
#endif
}

// Lane i of a private REAL or MASK variable, to read or to write.
#define REAL_LANE(variable, i) (((float*)&(variable))[i])
#define MASK_LANE(variable, i) (((int*)&(variable))[i])

typedef struct REAL3 {
  REAL x, y, z;
} REAL3;

static inline REAL3 real3(REAL x, REAL y, REAL z) {
  REAL3 r = {x, y, z};
  return r;
}
static inline REAL3 add3(REAL3 a, REAL3 b) { return real3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline REAL3 subtract3(REAL3 a, REAL3 b) { return real3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline REAL3 negate3(REAL3 a) { return real3(-a.x, -a.y, -a.z); }
static inline REAL3 scale3(REAL3 a, REAL s) { return real3(a.x * s, a.y * s, a.z * s); }
// a + s b: the point at distance s along a ray.
static inline REAL3 along3(REAL3 a, REAL s, REAL3 b) {
  return real3(fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z));
}
static inline REAL dot3(REAL3 a, REAL3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
static inline REAL3 select3(REAL3 a, REAL3 b, MASK m) {
  return real3(select(a.x, b.x, m), select(a.y, b.y, m), select(a.z, b.z, m));
}

// One instruction each, which fmin and fmax are not: a NaN in a gives b.
static inline REAL real_min(REAL a, REAL b) { return select(b, a, MASK_OF(a < b)); }
static inline REAL real_max(REAL a, REAL b) { return select(b, a, MASK_OF(a > b)); }
static inline REAL real_clamp(REAL a, REAL low, REAL high) { return real_min(real_max(a, low), high); }

// 1 / sqrt(x) and 1 / x: the rough ones to 1e-4, for the scale of an estimate; the others to 2 ulp for x > 0
// that are normal and below 1e37. AVX-512 starts from estimates of 14 bits, of the same bits in registers of
// every width, in a quarter of the time that exact roots and quotients take; elsewhere these are used.
#if defined(__AVX512VL__) && !defined(SUNDOG_PORTABLE)
#if LANES == 16
#define ROUGHLY(what, x) __builtin_ia32_##what##14ps512_mask(x, x, (ushort)0xFFFFu)
#elif LANES == 8
#define ROUGHLY(what, x) __builtin_ia32_##what##14ps256_mask(x, x, (uchar)0xFFu)
#elif LANES == 4
#define ROUGHLY(what, x) __builtin_ia32_##what##14ps128_mask(x, x, (uchar)0xFFu)
#else
#define ROUGHLY(what, x) first_of(__builtin_ia32_##what##14ps128_mask((float4)(x), (float4)(x), (uchar)0xFFu))
static inline float first_of(float4 four) { return four.x; }
#endif
static inline REAL rough_rsqrt(REAL x) { return ROUGHLY(rsqrt, x); }
static inline REAL rough_inverse(REAL x) { return ROUGHLY(rcp, x); }
static inline REAL real_rsqrt(REAL x) {
  const REAL y = rough_rsqrt(x), half_x = 0.5f * x;
  return fma(y, fma(-half_x * y, y, (REAL)(0.5f)), y);
}
static inline REAL real_inverse(REAL x) {
  const REAL y = rough_inverse(x);
  return fma(y, fma(-x, y, (REAL)(1.0f)), y);
}
#else
static inline REAL rough_rsqrt(REAL x) { return 1.0f / sqrt(x); }
static inline REAL rough_inverse(REAL x) { return 1.0f / x; }
static inline REAL real_rsqrt(REAL x) { return 1.0f / sqrt(x); }
static inline REAL real_inverse(REAL x) { return 1.0f / x; }
#endif
// x^(-n/2), n constant; n ulp. With y the rough root and e = 1 - x y^2 it is y^n (1 - e)^(-n/2).
static inline REAL inverse_root_power(REAL x, int n) {
  const REAL y = rough_rsqrt(x);
  REAL square = y * y, power = n & 1 ? y : (REAL)(1.0f);
  const REAL mend = fma(fma(-x, square, (REAL)(1.0f)), (REAL)(0.5f * (float)n), (REAL)(1.0f));
  for (int k = n >> 1; k; k >>= 1) {
    if (k & 1) power *= square;
    square *= square;
  }
  return power * mend;
}
static inline REAL real_sqrt(REAL x) { return sqrt(x); }

static inline REAL length3(REAL3 a) { return real_sqrt(dot3(a, a)); }

// Unit length; a vector without a direction gives +x.
static inline REAL3 unit3(REAL3 a) {
  const REAL square = dot3(a, a);
  const MASK good = MASK_OF(square > 0.0f) & MASK_OF(square < INFINITY);
  const REAL inverse = real_rsqrt(select((REAL)(1.0f), square, good));
  return select3(real3((REAL)(1.0f), (REAL)(0.0f), (REAL)(0.0f)), scale3(a, inverse), good);
}

// b where it is far enough from zero to divide by, else the nearest such number.
static inline REAL nonzero(REAL b) {
  return select(b, copysign((REAL)(1e-30f), b), MASK_OF(fabs(b) < 1e-30f));
}

// Natural logarithm of a positive normal number, to 2 ulp or 1e-7 absolute where that is more. Unlike the
// library's it has the same bits on every device. x = 2^e m with m in [sqrt(1/2), sqrt(2)); log m = y - y^2/2
// + y^3 p(y) in y = m - 1, p fitted on Chebyshev's nodes (error of the logarithm 7e-9). No division.
static inline REAL real_log(REAL x) {
  const MASK bits = AS_MASK(x) - 0x3f3504f3;  // of sqrt(1/2)
  const REAL e = TO_REAL(bits >> 23);
  const REAL y = AS_REAL((bits & 0x007fffff) + 0x3f3504f3) - 1.0f, z = y * y;
  const REAL p01 = fma(y, (REAL)(-0.250003064f), (REAL)(0.333333307f));
  const REAL p23 = fma(y, (REAL)(-0.166412815f), (REAL)(0.200010451f));
  const REAL p45 = fma(y, (REAL)(-0.129981838f), (REAL)(0.142144959f));
  const REAL p67 = fma(y, (REAL)(-0.0790274377f), (REAL)(0.126223198f));
  const REAL p = fma(z * z, fma(z, p67, p45), fma(z, p23, p01));
  const REAL tail = fma(y * z, p, e * 1.42860677e-6f);  // ln 2 in two parts: the first has few bits
  return fma(e, (REAL)(0.693145752f), y + fma((REAL)(-0.5f), z, tail));
}

#endif
