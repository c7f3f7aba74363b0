// One source for any number of lanes: REAL is a float or a vector of LANES floats, UINTS one of words, MASK
// an int or a vector of ints whose lanes are 0 or -1 (all bits set), even for scalars, so that select(),
// any() and bit operators work alike for LANES = 1, 4, 8 and 16. Comparisons go through MASK_OF(a < b). All
// functions give the same bits for any number of lanes. LANES is defined once for the whole program.
#pragma once
#include "lib/core/config.h"
#include "lib/core/masks.cl"

#ifndef LANES
#define LANES 16
#endif

// IN_LANES(name, end): the name with the number of lanes in it, without one for a single lane.
#define IN_LANES(name, end) IN_LANES_OF(name, LANE_DIGITS, end)
#define IN_LANES_OF(name, digits, end) IN_LANES_BY(name, digits, end)
#define IN_LANES_BY(name, digits, end) name##digits##end
#if LANES == 1
#define LANE_DIGITS
#define MASK_BY(type, comparison) (-(type)(comparison))
#define LOAD_LANES(from) (*(from))
#define STORE_LANES(v, to) (*(to) = (v))
#elif LANES == 4 || LANES == 8 || LANES == 16
#define LANE_DIGITS LANES
#define MASK_BY(type, comparison) (comparison)
#define LOAD_LANES(from) IN_LANES(vload, )(0, from)
#define STORE_LANES(v, to) IN_LANES(vstore, )(v, 0, to)
#else
#error "LANES must be 1, 4, 8 or 16"
#endif

#define MASK_OF(comparison) MASK_BY(int, comparison)
typedef IN_LANES(float, ) REAL;
typedef IN_LANES(int, ) MASK;
typedef IN_LANES(uint, ) UINTS;
#define AS_REAL(x) IN_LANES(as_float, )(x)
#define AS_MASK(x) IN_LANES(as_int, )(x)
#define AS_UINTS(x) IN_LANES(as_uint, )(x)
#define TO_REAL(x) IN_LANES(convert_float, )(x)
#define TO_MASK(x) IN_LANES(convert_int, _rtz)(x)
#define REAL_TO_UINTS(x) IN_LANES(convert_uint, _rtz)(x)
#define FIRST_(sixteen) (sixteen).s0
#define FIRST_4(sixteen) (sixteen).lo.lo
#define FIRST_8(sixteen) (sixteen).lo
#define FIRST_16(sixteen) (sixteen)
#define LANE_NUMBERS IN_LANES(FIRST_, )((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define LANE_BITS ((MASK)(1) << LANE_NUMBERS)

#define NO_LANES ((MASK)(0))
#define ALL_LANES ((MASK)(-1))
#define LANES_IF(condition) ((condition) ? ALL_LANES : NO_LANES)

// Whether any lane of the mask is set: a single instruction if available, because OpenCL's any() is a chain
// of branches in PoCL. And its bits: bit i is set if lane i is. Of one lane both are by the same comparison,
// so that compilers see that one follows from the other, and that a mask which is set is -1.
#define any_of(m) ((m) == ALL_LANES)
static inline int any_of4(int4 m) {
#if defined(__SSE__) && !defined(SUNDOG_PORTABLE)
  return __builtin_ia32_movmskps(as_float4(m)) != 0;
#else
  const int2 two = m.lo | m.hi;
  return two.x | two.y;
#endif
}
static inline int any_of8(int8 m) {
#if defined(__AVX__) && !defined(SUNDOG_PORTABLE)
  return __builtin_ia32_movmskps256(as_float8(m)) != 0;
#else
  return any_of4(m.lo | m.hi);
#endif
}
#define bits_of(m) ((u32)((m) == ALL_LANES))
#define bits_of4(m) (lane_mask((int8)(m, m)) & 15u)
#define bits_of8(m) lane_mask(m)
#define mask_of_bits(bits) MASK_OF(((MASK)((int)(bits)) & LANE_BITS) != 0)
#define mask_of_bits4(bits) mask_of_bits(bits)
#define mask_of_bits8(bits) mask_of_bits(bits)
#if defined(__AVX512DQ__) && !defined(SUNDOG_PORTABLE)
#define any_of16(m) (__builtin_ia32_cvtd2mask512(m) != 0)
#define bits_of16(m) (u32)(ushort) __builtin_ia32_cvtd2mask512(m)
#define mask_of_bits16(bits) __builtin_ia32_cvtmask2d512((ushort)(bits))
#else
#define any_of16(m) any_of8((m).lo | (m).hi)
#define bits_of16(m) (lane_mask((m).lo) | lane_mask((m).hi) << 8)
#define mask_of_bits16(bits) mask_of_bits(bits)
#endif
static inline int any_lane(MASK m) { return IN_LANES(any_of, )(m); }
static inline u32 lane_bits(MASK m) { return IN_LANES(bits_of, )(m); }
static inline MASK lanes_of(u32 bits) { return IN_LANES(mask_of_bits, )(bits); }
static inline u32 lane_count(MASK m) { return popcount(lane_bits(m)); }

// A loop over the lanes of `lanes` by their numbers i, the lowest first.
#define EACH_LANE(i, lanes)                                                              \
  for (u32 i, i##_left = lane_bits(lanes); i##_left && (i = lowest_bit(i##_left), true); \
       i##_left &= i##_left - 1u)

// Lane i of a private REAL or MASK variable, as an lvalue. Not all compilers see that i is 0 where there is
// one lane: they would keep the variable in memory.
#define REAL_LANE(variable, i) (((float*)&(variable))[(i) * (LANES > 1)])
#define MASK_LANE(variable, i) (((int*)&(variable))[(i) * (LANES > 1)])

// Removes from `left`, a nonzero set of lanes, those with the same index as its first lane, so that a table's
// entry is read once for all of them.
static inline MASK take_alike(MASK index, u32* left, u32* value) {
  *value = (u32)MASK_LANE(index, lowest_bit(*left));
  const u32 alike = *left & lane_bits(MASK_OF(index == (MASK)((int)*value)));
  *left &= ~alike;
  return lanes_of(alike);
}

// Writes the lanes of the mask contiguously. May overwrite up to LANES - 1 values after them.
static inline void write_packed(float* to, REAL v, MASK m) {
#if LANES == 1
  *to = v;
#elif LANES == 16 && defined(__AVX512F__) && !defined(SUNDOG_PORTABLE)
  vstore16(__builtin_ia32_compresssf512_mask(v, v, (ushort)lane_bits(m)), 0, to);
#elif LANES == 8 && defined(__AVX512VL__) && !defined(SUNDOG_PORTABLE)
  vstore8(__builtin_ia32_compresssf256_mask(v, v, (uchar)lane_bits(m)), 0, to);
#else
  u32 count = 0;
  EACH_LANE(i, m) to[count++] = REAL_LANE(v, i);
#endif
}
static inline REAL read_lanes(const float* from) { return LOAD_LANES(from); }
static inline REAL load_lanes(__global const float* from) { return LOAD_LANES(from); }
static inline void write_lanes(float* to, REAL v) { STORE_LANES(v, to); }

typedef struct REAL3 {
  REAL x, y, z;
} REAL3;

static inline REAL3 real3(REAL x, REAL y, REAL z) {
  REAL3 r = {x, y, z};
  return r;
}
// Rows of four numbers, the first one's in the first lane, and so on.
static inline void load_rows(__global const float4* rows, REAL3* xyz, REAL* w) {
#if LANES == 1
  *xyz = real3(rows->x, rows->y, rows->z);
  *w = rows->w;
#else
  __global const float* from = (__global const float*)rows;
  const REAL a = LOAD_LANES(from), b = LOAD_LANES(from + LANES), c = LOAD_LANES(from + 2 * LANES),
             d = LOAD_LANES(from + 3 * LANES);
  const REAL xz_low = (REAL)(a.even, b.even), xz_high = (REAL)(c.even, d.even), yw_low = (REAL)(a.odd, b.odd),
             yw_high = (REAL)(c.odd, d.odd);
  *xyz = real3((REAL)(xz_low.even, xz_high.even), (REAL)(yw_low.even, yw_high.even),
               (REAL)(xz_low.odd, xz_high.odd));
  *w = (REAL)(yw_low.odd, yw_high.odd);
#endif
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
static inline REAL3 cross3(REAL3 a, REAL3 b) {
  return real3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline REAL3 select3(REAL3 a, REAL3 b, MASK m) {
  return real3(select(a.x, b.x, m), select(a.y, b.y, m), select(a.z, b.z, m));
}

static inline REAL3 multiply3(REAL3 a, REAL3 b) { return real3(a.x * b.x, a.y * b.y, a.z * b.z); }
static inline REAL3 divide3(REAL3 a, REAL3 b) { return real3(a.x / b.x, a.y / b.y, a.z / b.z); }
// A vector in all lanes; lane i of vectors, to read or write.
static inline REAL3 all3(float3 a) { return real3((REAL)(a.x), (REAL)(a.y), (REAL)(a.z)); }
static inline float3 get3(const REAL3* a, u32 i) {
  return (float3)(REAL_LANE(a->x, i), REAL_LANE(a->y, i), REAL_LANE(a->z, i));
}
static inline void set3(REAL3* a, u32 i, float3 value) {
  REAL_LANE(a->x, i) = value.x;
  REAL_LANE(a->y, i) = value.y;
  REAL_LANE(a->z, i) = value.z;
}

typedef struct REAL4 {
  REAL x, y, z, w;
} REAL4;

static inline REAL4 real4(REAL x, REAL y, REAL z, REAL w) {
  const REAL4 r = {x, y, z, w};
  return r;
}
static inline REAL4 select4(REAL4 a, REAL4 b, MASK m) {
  return real4(select(a.x, b.x, m), select(a.y, b.y, m), select(a.z, b.z, m), select(a.w, b.w, m));
}
static inline REAL4 all4(float4 a) { return real4((REAL)(a.x), (REAL)(a.y), (REAL)(a.z), (REAL)(a.w)); }
static inline REAL4 add4(REAL4 a, REAL4 b) { return real4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w); }
static inline REAL4 subtract4(REAL4 a, REAL4 b) { return real4(a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w); }
static inline REAL4 multiply4(REAL4 a, REAL4 b) { return real4(a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w); }
static inline REAL4 scale4(REAL4 a, REAL s) { return real4(a.x * s, a.y * s, a.z * s, a.w * s); }

// One instruction each, which fmin and fmax are not: a NaN in a gives b.
static inline REAL real_min(REAL a, REAL b) { return select(b, a, MASK_OF(a < b)); }
static inline REAL real_max(REAL a, REAL b) { return select(b, a, MASK_OF(a > b)); }
static inline REAL real_clamp(REAL a, REAL low, REAL high) { return real_min(real_max(a, low), high); }

// 1 / sqrt(x) and 1 / x: the rough ones to 1e-4, for scaling an estimate; the others to 2 ulp for normal x >
// 0 below 1e37. AVX-512 starts from 14-bit estimates, equal in registers of any width, in a quarter of the
// time of exact roots and quotients, which other processors use.
#if defined(__AVX512VL__) && !defined(SUNDOG_PORTABLE)
#define HAS_ESTIMATES 1
#define ESTIMATE_16(name, x) __builtin_ia32_##name##512_mask(x, x, (ushort)0xFFFFu)
#define ESTIMATE_8(name, x) __builtin_ia32_##name##256_mask(x, x, (uchar)0xFFu)
#define ESTIMATE_4(name, x) __builtin_ia32_##name##128_mask(x, x, (uchar)0xFFu)
#define ESTIMATE_(name, x) first_of(ESTIMATE_4(name, (float4)(x)))
#define ROUGH_RSQRT(x) IN_LANES(ESTIMATE_, )(rsqrt14ps, x)
#define ROUGH_INVERSE(x) IN_LANES(ESTIMATE_, )(rcp14ps, x)
static inline float first_of(float4 four) { return four.x; }
#else
#define HAS_ESTIMATES 0
#define ROUGH_RSQRT(x) (1.0f / sqrt(x))
#define ROUGH_INVERSE(x) (1.0f / (x))
#endif
static inline REAL rough_rsqrt(REAL x) { return ROUGH_RSQRT(x); }
static inline REAL rough_inverse(REAL x) { return ROUGH_INVERSE(x); }
static inline REAL real_rsqrt(REAL x) {
  if (!HAS_ESTIMATES) return 1.0f / sqrt(x);
  const REAL y = rough_rsqrt(x), half_x = 0.5f * x;
  return fma(y, fma(-half_x * y, y, (REAL)(0.5f)), y);
}
static inline REAL real_inverse(REAL x) {
  if (!HAS_ESTIMATES) return 1.0f / x;
  const REAL y = rough_inverse(x);
  return fma(y, fma(-x, y, (REAL)(1.0f)), y);
}
// 1 / x as rounded by division, for the same x; 1 ulp off if all bits of the mantissa are set (Markstein
// 1990, "Computation of Elementary Functions on the IBM RISC System/6000 Processor").
static inline REAL rounded_inverse(REAL x) {
  if (!HAS_ESTIMATES) return 1.0f / x;
  const REAL y = real_inverse(x);
  return fma(fma(-x, y, (REAL)(1.0f)), y, y);
}
// x^(-n/2), n constant; n ulp. With the rough root y and e = 1 - x y^2 it is y^n (1 - e)^(-n/2).
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

static inline REAL greatest3(REAL3 a) { return real_max(a.x, real_max(a.y, a.z)); }
static inline REAL length3(REAL3 a) { return real_sqrt(dot3(a, a)); }

// Normalises; a vector without a direction gives +x.
static inline REAL3 unit3(REAL3 a) {
  const REAL square = dot3(a, a);
  const MASK good = MASK_OF(square > 0.0f) & MASK_OF(square < INFINITY);
  const REAL inverse = real_rsqrt(select((REAL)(1.0f), square, good));
  return select3(real3((REAL)(1.0f), (REAL)(0.0f), (REAL)(0.0f)), scale3(a, inverse), good);
}

// Normalises vectors of any length: scenes may be in nanometres or light years, and the squared length would
// overflow. A power of two first scales the largest component to [1, 2). Zero and infinity are unchanged.
static inline REAL3 safe_unit3(REAL3 a) {
  const REAL size = real_max(fabs(a.x), real_max(fabs(a.y), fabs(a.z)));
  const REAL scale = AS_REAL(max(0x7f000000 - (AS_MASK(size) & 0x7f800000), (MASK)(0x00800000)));
  const REAL3 b = scale3(a, scale);
  return select3(a, scale3(b, real_rsqrt(dot3(b, b))), MASK_OF(size > 0.0f) & MASK_OF(size < INFINITY));
}
// Normalises vectors of moderate length, such as a sum of unit vectors.
static inline REAL3 renormalized3(REAL3 a) { return scale3(a, real_rsqrt(dot3(a, a))); }

// b if its magnitude suffices for a divisor, else the nearest such number.
static inline REAL nonzero(REAL b) {
  return select(b, copysign((REAL)(1e-30f), b), MASK_OF(fabs(b) < 1e-30f));
}

// An angle that libraries take by their shortest way: theirs for greater ones, from 125 on in SLEEF, gives
// other last bits, and one lane leads all lanes there. Less its turns, in two parts of which the first has
// few bits.
static inline REAL near_angle(REAL a) {
  const REAL turns = rint(a * 0.159154943f);
  const REAL rest = fma(turns, (REAL)(-0.00193530718f), fma(turns, (REAL)(-6.28125f), a));
  return select(fmin(fmax(rest, -4.0f), 4.0f), a, MASK_OF(fabs(a) <= 120.0f));
}

// Sine and cosine that do not depend on what other lanes hold; not a number for what is none, or infinite.
static inline REAL real_sin(REAL a) { return select(a - a, sin(near_angle(a)), MASK_OF(fabs(a) <= FLT_MAX)); }
static inline REAL real_cos(REAL a) { return select(a - a, cos(near_angle(a)), MASK_OF(fabs(a) <= FLT_MAX)); }

// Natural logarithm of a positive normal number, to 2 ulp or 1e-7 absolute, whichever is larger. Unlike the
// library's, it has the same bits on every device. x = 2^e m with m in [sqrt(1/2), sqrt(2)); log m = y -
// y^2/2 + y^3 p(y) in y = m - 1, with p fitted at Chebyshev nodes (error of the logarithm 7e-9). No division.
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

// e^x to 3 ulp; 0 below e^-87, clamped above e^88.
static inline REAL real_exp(REAL x) {
  const REAL y = real_clamp(x, (REAL)(-87.0f), (REAL)(88.0f));
  const REAL n = fma(y, (REAL)(1.44269504f), (REAL)(12582912.0f)) - 12582912.0f;  // to the nearest integer
  const REAL r = fma(n, (REAL)(-1.42860677e-6f), fma(n, (REAL)(-0.693145752f), y));
  REAL p = fma(r, (REAL)(1.0f / 720.0f), (REAL)(1.0f / 120.0f));
  p = fma(r, p, (REAL)(1.0f / 24.0f));
  p = fma(r, p, (REAL)(1.0f / 6.0f));
  p = fma(r, p, (REAL)(0.5f));
  p = fma(r * r, p, r) + 1.0f;
  return select(AS_REAL(AS_MASK(p) + (TO_MASK(n) << 23)), (REAL)(0.0f), MASK_OF(x < -87.0f));
}

#if LANES > 1 && defined(__AVX2__) && !defined(SUNDOG_PORTABLE)
static inline int8 gather_eight(__global const u32* from, int8 index, int8 lanes) {
  return __builtin_ia32_gatherd_d256((int8)(0), (const void*)(size_t)from, index, lanes, 4);
}
#endif

// Words at the indices of `lanes`, relative to `from`; 0 in other lanes.
static inline MASK gather_words(__global const u32* from, MASK index, MASK lanes) {
#if LANES == 1
  return lanes ? (int)from[index] : 0;
#elif LANES == 16 && defined(__AVX512F__) && !defined(SUNDOG_PORTABLE)
  return __builtin_ia32_gathersiv16si(NO_LANES, (const void*)(size_t)from, index, (ushort)lane_bits(lanes),
                                      4);
#elif LANES == 16 && defined(__AVX2__) && !defined(SUNDOG_PORTABLE)
  return (MASK)(gather_eight(from, index.lo, lanes.lo), gather_eight(from, index.hi, lanes.hi));
#elif LANES == 8 && defined(__AVX2__) && !defined(SUNDOG_PORTABLE)
  return gather_eight(from, index, lanes);
#elif LANES == 4 && defined(__AVX2__) && !defined(SUNDOG_PORTABLE)
  return __builtin_ia32_gatherd_d(NO_LANES, (const void*)(size_t)from, index, lanes, 4);
#else
  MASK words = NO_LANES;
  EACH_LANE(i, lanes) { MASK_LANE(words, i) = (int)from[MASK_LANE(index, i)]; }
  return words;
#endif
}
static inline REAL gather_floats(__global const float* from, MASK index, MASK lanes) {
  return AS_REAL(gather_words((__global const u32*)from, index, lanes));
}
