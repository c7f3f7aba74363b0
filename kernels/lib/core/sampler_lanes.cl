// The sample values of shared/sampler.h for one pixel sample per lane, with the same bits. Pure functions of
// pixel, sample and dimension.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/sampler.cl"
#include "shared/filter.h"

static inline UINTS hash_lanes(UINTS x) {
  const UINTS state = x * 747796405u + 2891336453u;
  const UINTS word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

static inline UINTS reversed_lanes(UINTS r) {
  r = (r << 16) | (r >> 16);
  r = ((r & 0x00ff00ffu) << 8) | ((r & 0xff00ff00u) >> 8);
  r = ((r & 0x0f0f0f0fu) << 4) | ((r & 0xf0f0f0f0u) >> 4);
  r = ((r & 0x33333333u) << 2) | ((r & 0xccccccccu) >> 2);
  return ((r & 0x55555555u) << 1) | ((r & 0xaaaaaaaau) >> 1);
}

static inline UINTS owen_lanes(UINTS x, UINTS seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ x * 0x53a22864u;
}

// unit_float() of bits: 24 of them are an int above 0.
static inline REAL unit_lanes(UINTS bits) { return TO_REAL(AS_MASK(bits >> 8)) * 0x1p-24f; }

// A sum of four columns, looked up among the sixteen if vectors allow.
#if LANES == 16 && defined(__AVX512F__) && !defined(SUNDOG_PORTABLE)
#define SUMS_OF_FOUR(a, b, c, d)                                                                    \
  (int16)(0, a, b, a ^ b, c, a ^ c, b ^ c, a ^ b ^ c, d, a ^ d, b ^ d, a ^ b ^ d, c ^ d, a ^ c ^ d, \
          b ^ c ^ d, a ^ b ^ c ^ d)
#define LANE_COLUMNS(bit, a, b, c, d) \
  AS_UINTS(__builtin_ia32_permvarsi512(SUMS_OF_FOUR(a, b, c, d), AS_MASK(order >> bit)))
#else
#define LANE_COLUMNS SOBOL_COLUMNS
#endif

static inline REAL scrambled_lanes(UINTS reversed, UINTS seed, u32 component) {
  const UINTS own = hash_lanes(seed + 0x9e3779b9u * (component + 1u));
  return unit_lanes(reversed_lanes(owen_lanes(reversed & 0xffffu, own)));
}

static inline UINTS second_lanes(UINTS order) {
  order ^= order << 16;
  order ^= (order & 0x00ff00ffu) << 8;
  order ^= (order & 0x0f0f0f0fu) << 4;
  order ^= (order & 0x33333333u) << 2;
  return order ^ (order & 0x55555555u) << 1;
}

static inline REAL blue_noise_lanes(UINTS place, UINTS dimension) {
  return unit_lanes(reversed_lanes(owen_lanes(reversed_lanes(place), hash_lanes(dimension + 0x9e3779b9u))));
}

// The pixel and sample of each lane, and the frame's SceneInfo.seed.
typedef struct LaneSamples {
  MASK x, y, sample;
  u32 seed;
} LaneSamples;

static inline void join_samples(LaneSamples* at, const LaneSamples* other, MASK lanes) {
  at->x = select(at->x, other->x, lanes);
  at->y = select(at->y, other->y, lanes);
  at->sample = select(at->sample, other->sample, lanes);
}

// Two numbers in [0, 1) for each lane, of the dimensions from `own` on, an even number, by the samplers whose
// dimensions have no more in common.
static inline void unlinked_pair(const LaneSamples* at, UINTS own, REAL* u, REAL* v) {
  const UINTS x = AS_UINTS(at->x), y = AS_UINTS(at->y), sample = AS_UINTS(at->sample);
  if (SAMPLER == SAMPLER_BLUE_NOISE) {
    const UINTS index = reversed_lanes(Z_ORDER(x, y) << SAMPLE_ROOM | sample);
    const UINTS place = owen_lanes(index, hash_lanes(own >> 1));
    *u = blue_noise_lanes(place, own);
    *v = blue_noise_lanes(second_lanes(place), own + 1u);
  } else {
    *u = unit_lanes(hash_lanes(sample + hash_lanes(x + hash_lanes(y + hash_lanes(own)))));
    *v = unit_lanes(hash_lanes(sample + hash_lanes(x + hash_lanes(y + hash_lanes(own + 1u)))));
  }
}

// Four numbers in [0, 1) per lane, of the dimensions from `dimension`, a multiple of four, on.
typedef struct FourNumbers {
  REAL x, y, z, w;
} FourNumbers;

// The numbers selected by `first` (the first two) and `later` (the other two); one half elsewhere.
static inline FourNumbers chosen_lanes(const LaneSamples* at, MASK dimension, bool first, bool later) {
  const UINTS own = AS_UINTS(dimension) + at->seed;
  const REAL half_way = (REAL)(0.5f);
  FourNumbers u = {half_way, half_way, half_way, half_way};
  if ((SAMPLER == SAMPLER_BLUE_NOISE) | (SAMPLER == SAMPLER_INDEPENDENT)) {
    if (first) unlinked_pair(at, own, &u.x, &u.y);
    if (later) unlinked_pair(at, own + 2u, &u.z, &u.w);
    return u;
  }
  const UINTS seed = hash_lanes(AS_UINTS(at->x) + hash_lanes(AS_UINTS(at->y) + hash_lanes(own >> 2)));
  const UINTS order = owen_lanes(reversed_lanes(AS_UINTS(at->sample)) >> 16, seed) & 0xffffu;
  if (first) {
    const UINTS pair = SOBOL_PAIR_01(LANE_COLUMNS);
    u.x = scrambled_lanes(pair, seed, 0u);
    u.y = scrambled_lanes(pair >> 16, seed, 1u);
  }
  if (later) {
    const UINTS pair = SOBOL_PAIR_23(LANE_COLUMNS);
    u.z = scrambled_lanes(pair, seed, 2u);
    u.w = scrambled_lanes(pair >> 16, seed, 3u);
  }
  return u;
}

// Two of the four: the first two, or with `later` the other two.
static inline void pair_lanes(const LaneSamples* at, MASK dimension, bool later, REAL* u, REAL* v) {
  const FourNumbers chosen = chosen_lanes(at, dimension, !later, later);
  *u = later ? chosen.z : chosen.x;
  *v = later ? chosen.w : chosen.y;
}

// The Hammersley set of `samples` points, shifted per pixel (Cranley and Patterson 1976).
static inline void hammersley_lanes(const LaneSamples* at, u32 samples, REAL* u, REAL* v) {
  const UINTS x = AS_UINTS(at->x), y = AS_UINTS(at->y);
  const UINTS shift_u = hash_lanes(x + hash_lanes(y + hash_u32(at->seed))),
              shift_v = hash_lanes(x + hash_lanes(y + hash_u32(at->seed + 1u)));
  const REAL a = (TO_REAL(at->sample) + 0.5f) / (float)samples + unit_lanes(shift_u);
  *u = real_min(a - floor(a), (REAL)(0x1.fffffep-1f));
  *v = unit_lanes(reversed_lanes(AS_UINTS(at->sample)) + shift_v);
}

// Positions of the camera samples of `lanes` in their pixels, in [0, 1)^2: the centre if `samples`, those of
// a pixel, is one.
static inline void places_in_pixels(const LaneSamples* at, MASK lanes, u32 samples, REAL* u, REAL* v) {
  *u = *v = (REAL)(0.5f);
  if (samples <= 1u) return;
  if (SAMPLER == SAMPLER_AUTO) {
    hammersley_lanes(at, samples, u, v);
  } else if ((SAMPLER == SAMPLER_REGULAR) | (SAMPLER == SAMPLER_STRATIFIED)) {
    EACH_LANE(i, lanes) {
      const uint2 pixel = (uint2)((u32)MASK_LANE(at->x, i), (u32)MASK_LANE(at->y, i));
      const float2 place = place_in_grid(pixel, (u32)MASK_LANE(at->sample, i), samples, at->seed);
      REAL_LANE(*u, i) = place.x;
      REAL_LANE(*v, i) = place.y;
    }
  } else {
    pair_lanes(at, (MASK)((int)DIMENSION_PIXEL), false, u, v);
  }
}
