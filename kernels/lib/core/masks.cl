// Eight-lane helpers: masks and ordering of floats.
#pragma once
#include "lib/core/config.h"
#include "shared/types.h"

// Bit i of the result is the sign bit of lane i.
static inline u32 lane_mask(int8 lanes) {
#if defined(__AVX__) && !defined(SUNDOG_PORTABLE)
  return (u32)__builtin_ia32_movmskps256(as_float8(lanes));
#else
  // Keep one bit per byte; the product gathers the eight bits in its top byte.
  const ulong bits = as_ulong(convert_char8(lanes >> 31)) & 0x8040201008040201UL;
  return (u32)((bits * 0x0101010101010101UL) >> 56);
#endif
}

// Index of the lowest set bit; mask is not 0.
static inline u32 lowest_bit(u32 mask) {
#if defined(__AVX__) && !defined(SUNDOG_PORTABLE)
  return (u32)__builtin_ctz(mask);
#else
  return 31u - clz(mask & (0u - mask));
#endif
}

// Not fmin and fmax, whose handling of NaN costs instructions.
static inline float8 least8(float8 a, float8 b) { return select(b, a, a < b); }
static inline float8 greatest8(float8 a, float8 b) { return select(b, a, a > b); }
