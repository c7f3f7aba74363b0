// Procedural patterns: each gives a number t that mixes two colours, from the position q in pattern units and
// the footprint w, above a cell's size of which a pattern becomes its mean. One point per lane.
#pragma once
#include "lib/core/lanes.h"

#if LANES == 1
typedef uint UMASK;
#define AS_UMASK(x) as_uint(x)
#elif LANES == 4
typedef uint4 UMASK;
#define AS_UMASK(x) as_uint4(x)
#elif LANES == 8
typedef uint8 UMASK;
#define AS_UMASK(x) as_uint8(x)
#else
typedef uint16 UMASK;
#define AS_UMASK(x) as_uint16(x)
#endif

static inline REAL fraction(REAL x) { return x - floor(x); }
static inline REAL smooth_step(REAL s) { return s * s * (3.0f - 2.0f * s); }

// Narrower footprints are not filtered: the difference of two integrals would be mere rounding.
#define PATTERN_SHARP 1e-3f

// The fraction of the width w around x in the cell of x, between integers, minus that in the neighbouring
// cells; 0 above w = 2.
static inline REAL own_part(REAL x, REAL w) {
  const REAL f = fraction(x);
  return real_min(2.0f * real_min(f, 1.0f - f), real_min(w, real_max(2.0f - w, (REAL)(0.0f))));
}

// 1 on the last `share` of each unit of x, else 0; filtered.
static inline REAL pulse(REAL x, float share, REAL w) {
  const REAL a = x - 0.5f * w, b = x + 0.5f * w, zero = (REAL)(0.0f);
  const REAL turns_between = floor(b) - floor(a);
  const REAL from = real_max(fraction(a) - (1.0f - share), zero),
             to = real_max(fraction(b) - (1.0f - share), zero);
  const REAL sharp = select(zero, (REAL)(1.0f), MASK_OF(fraction(x) >= 1.0f - share));
  const MASK wide = MASK_OF(w > PATTERN_SHARP);
  return select(sharp, fma(turns_between, (REAL)(share), to - from) / select((REAL)(1.0f), w, wide), wide);
}

// The fraction of a footprint on a plane with unit normal n along each axis.
static inline REAL3 sines_to_axes(REAL3 n) {
  const REAL3 rest = subtract3(all3((float3)(1.0f)), multiply3(n, n));
  const REAL zero = (REAL)(0.0f);
  return real3(real_sqrt(real_max(rest.x, zero)), real_sqrt(real_max(rest.y, zero)),
               real_sqrt(real_max(rest.z, zero)));
}

// The visible fraction of odd cells: a box filter along each axis (Quilez 2011, "Checkerboard filtering"),
// without its ripples above two cells.
static inline REAL checker_pattern(REAL3 q, REAL3 w) {
  const float off = 0x1p-17f;  // off the lattice, so that a face on a cell's border has one colour
  const float sharp = 1e-5f;
  const REAL x = q.x + off, y = q.y + off, z = q.z + off;
  const REAL wx = real_max(w.x, (REAL)(sharp)), wy = real_max(w.y, (REAL)(sharp)),
             wz = real_max(w.z, (REAL)(sharp));
  const REAL contrast = own_part(x, wx) * own_part(y, wy) * own_part(z, wz) / (wx * wy * wz);
  const MASK odd = MASK_OF(fraction(0.5f * (floor(x) + floor(y) + floor(z))) > 0.25f);
  return fma(select((REAL)(-0.5f), (REAL)(0.5f), odd), contrast, (REAL)(0.5f));
}

static inline REAL brick_pattern(REAL3 q, REAL3 w, float mortar_x, float mortar_y) {
  const REAL shift = select((REAL)(0.0f), (REAL)(0.5f), MASK_OF(fraction(0.5f * floor(q.y)) > 0.25f));
  return 1.0f - (1.0f - pulse(q.x + shift, mortar_x, w.x)) * (1.0f - pulse(q.y, mortar_y, w.y));
}

// A hash of a lattice point (the finaliser of Appleby's MurmurHash3 over products with odd numbers).
static inline UMASK lattice_hash(MASK x, MASK y, MASK z) {
  UMASK h = AS_UMASK(x) * 0x8da6b343u + AS_UMASK(y) * 0xd8163841u + AS_UMASK(z) * 0xcb1ab31fu;
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}
static inline REAL unit_of_hash(UMASK h) { return TO_REAL(AS_MASK(h >> 8)) * 0x1p-24f; }

// A corner's noise: a number in [-1, 1], or the product of one of twelve gradients with the vector from the
// corner (Perlin 2002, "Improving Noise").
static inline REAL corner_noise(UMASK h, REAL x, REAL y, REAL z, bool gradient) {
  if (!gradient) return 2.0f * unit_of_hash(h) - 1.0f;
  const MASK k = AS_MASK(h & 15u);
  const REAL a = select(y, x, MASK_OF(k < 8));
  const REAL b = select(select(z, x, MASK_OF(k == 12) | MASK_OF(k == 14)), y, MASK_OF(k < 4));
  return select(a, -a, MASK_OF((k & 1) != 0)) + select(b, -b, MASK_OF((k & 2) != 0));
}

// Noise on the integer lattice, in [-1, 1].
NEVER_INLINE REAL lattice_noise(REAL3 q, bool gradient) {
  const REAL3 low = real3(floor(q.x), floor(q.y), floor(q.z));
  const REAL3 f = subtract3(q, low);
  const MASK x = TO_MASK(low.x), y = TO_MASK(low.y), z = TO_MASK(low.z);
  const REAL3 s = real3(f.x * f.x * f.x * fma(f.x, fma(f.x, (REAL)(6.0f), (REAL)(-15.0f)), (REAL)(10.0f)),
                        f.y * f.y * f.y * fma(f.y, fma(f.y, (REAL)(6.0f), (REAL)(-15.0f)), (REAL)(10.0f)),
                        f.z * f.z * f.z * fma(f.z, fma(f.z, (REAL)(6.0f), (REAL)(-15.0f)), (REAL)(10.0f)));
  REAL planes[2];
  for (int k = 0; k < 2; ++k) {
    REAL rows[2];
    for (int j = 0; j < 2; ++j) {
      const REAL left =
          corner_noise(lattice_hash(x, y + j, z + k), f.x, f.y - (float)j, f.z - (float)k, gradient);
      const REAL right = corner_noise(lattice_hash(x + 1, y + j, z + k), f.x - 1.0f, f.y - (float)j,
                                      f.z - (float)k, gradient);
      rows[j] = fma(s.x, right - left, left);
    }
    planes[k] = fma(s.y, rows[1] - rows[0], rows[0]);
  }
  return fma(s.z, planes[1] - planes[0], planes[0]);
}

// Octaves of noise, each twice as fine and `gain` times as strong; fades details finer than the footprint.
static inline REAL octave_noise(REAL3 q, REAL w, u32 octaves, float gain, bool gradient) {
  REAL sum = (REAL)(0.0f);
  float strength = 1.0f, all = 0.0f, frequency = 1.0f;
  for (u32 i = 0; i < octaves; ++i) {
    const REAL seen = real_clamp(2.0f - 2.0f * frequency * w, (REAL)(0.0f), (REAL)(1.0f));
    const REAL3 at = scale3(q, (REAL)(frequency));
    if (any_lane(MASK_OF(seen > 0.0f))) sum = fma(strength * seen, lattice_noise(at, gradient), sum);
    all += strength;
    strength *= gain;
    frequency *= 2.0f;
  }
  return sum / fmax(all, 1e-6f);
}

// Distance to the nearest of one point per cell (Worley 1996, "A Cellular Texture Basis Function").
static inline REAL cell_distance(REAL3 q, REAL w) {
  const REAL3 low = real3(floor(q.x), floor(q.y), floor(q.z));
  const REAL3 f = subtract3(q, low);
  const MASK x = TO_MASK(low.x), y = TO_MASK(low.y), z = TO_MASK(low.z);
  REAL nearest = (REAL)(9.0f);
  for (int k = 0; k < 27; ++k) {
    const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
    const UMASK h = lattice_hash(x + dx, y + dy, z + dz);
    const REAL3 to = real3((float)dx + TO_REAL(AS_MASK(h & 1023u)) * (1.0f / 1023.0f) - f.x,
                           (float)dy + TO_REAL(AS_MASK(h >> 10 & 1023u)) * (1.0f / 1023.0f) - f.y,
                           (float)dz + TO_REAL(AS_MASK(h >> 20 & 1023u)) * (1.0f / 1023.0f) - f.z);
    nearest = real_min(nearest, dot3(to, to));
  }
  const REAL seen = real_clamp(2.0f - 2.0f * w, (REAL)(0.0f), (REAL)(1.0f)), mean = (REAL)(0.55f);
  return fma(seen, real_min(real_sqrt(nearest), (REAL)(1.0f)) - mean, mean);
}

// Veins: bands across x disturbed by noise (after Perlin 1985, "An Image Synthesizer"; a smoothed triangle
// wave replaces the sine).
static inline REAL marble_pattern(REAL3 q, REAL w, u32 octaves, float gain, float turbulence) {
  const REAL x = fma(octave_noise(q, w, octaves, gain, true), (REAL)(turbulence), q.x);
  const REAL t = smooth_step(fabs(2.0f * fraction(x) - 1.0f));
  const REAL seen = real_clamp(2.0f - 2.0f * w, (REAL)(0.0f), (REAL)(1.0f));
  return fma(seen, t - 0.5f, (REAL)(0.5f));
}

// Rings about y, from light to dark and quickly back.
static inline REAL wood_pattern(REAL3 q, REAL w, u32 octaves, float gain, float turbulence) {
  const float late = 0.85f;
  const REAL r = real_sqrt(fma(q.x, q.x, q.z * q.z));
  const REAL s = fraction(fma(octave_noise(q, w, octaves, gain, true), (REAL)(turbulence), r));
  const REAL rising = s * (1.0f / late),
             t = select(rising * rising, (1.0f - s) / (1.0f - late), MASK_OF(s > late));
  const REAL seen = real_clamp(2.0f - 2.0f * w, (REAL)(0.0f), (REAL)(1.0f));
  return fma(seen, t - 0.36f, (REAL)(0.36f));
}
