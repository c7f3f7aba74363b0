// Procedural patterns: each gives a number t that mixes two colours, from the position q in pattern units and
// the footprint w, above a cell's size of which a pattern becomes its mean.
#include "plain/core.h"

static inline float fraction(float x) { return x - floor(x); }
static inline float smooth_step(float s) { return s * s * (3.0f - 2.0f * s); }

// Narrower footprints are not filtered: the difference of two integrals would be mere rounding.
#define PATTERN_SHARP 1e-3f
// Moves points off the lattice, so that a face on a cell's border has one colour.
#define PATTERN_OFF_LATTICE 0x1p-17f

// The fraction of the width w around x in the cell of x, between integers, minus that in the neighbouring
// cells; 0 above w = 2.
static inline float own_part(float x, float w) {
  const float f = fraction(x);
  return real_min(2.0f * real_min(f, 1.0f - f), real_min(w, real_max(2.0f - w, 0.0f)));
}

// 1 on the last `share` of each unit of x, else 0; filtered.
static inline float pulse(float at, UNIFORM float share, float w) {
  const float x = at + PATTERN_OFF_LATTICE;
  if (!(w > PATTERN_SHARP)) return fraction(x) >= 1.0f - share ? 1.0f : 0.0f;
  const float a = x - 0.5f * w, b = x + 0.5f * w;
  const float from = real_max(fraction(a) - (1.0f - share), 0.0f),
              to = real_max(fraction(b) - (1.0f - share), 0.0f);
  return fma(floor(b) - floor(a), share, to - from) / w;
}

// The fraction of a footprint on a plane with unit normal n along each axis.
static inline float3 sines_to_axes(float3 n) {
  const float3 rest = 1.0f - n * n;
  return (float3)(real_sqrt(real_max(rest.x, 0.0f)), real_sqrt(real_max(rest.y, 0.0f)),
                  real_sqrt(real_max(rest.z, 0.0f)));
}

// The visible fraction of odd cells: a box filter along each axis (Quilez 2011, "Checkerboard filtering"),
// without its ripples above two cells.
static inline float checker_pattern(float3 q, float3 w) {
  const float3 at = q + PATTERN_OFF_LATTICE;
  const float wx = real_max(w.x, 1e-5f), wy = real_max(w.y, 1e-5f), wz = real_max(w.z, 1e-5f);
  const float contrast = own_part(at.x, wx) * own_part(at.y, wy) * own_part(at.z, wz) / (wx * wy * wz);
  const bool odd = fraction(0.5f * (floor(at.x) + floor(at.y) + floor(at.z))) > 0.25f;
  return fma(odd ? 0.5f : -0.5f, contrast, 0.5f);
}

static inline float brick_pattern(float3 q, float3 w, UNIFORM float mortar_x, UNIFORM float mortar_y) {
  const float shift = fraction(0.5f * floor(q.y + PATTERN_OFF_LATTICE)) > 0.25f ? 0.5f : 0.0f;
  return 1.0f - (1.0f - pulse(q.x + shift, mortar_x, w.x)) * (1.0f - pulse(q.y, mortar_y, w.y));
}

// A hash of a lattice point (the finaliser of Appleby's MurmurHash3 over products with odd numbers).
static inline u32 lattice_hash(int x, int y, int z) {
  u32 h = (u32)x * 0x8da6b343u + (u32)y * 0xd8163841u + (u32)z * 0xcb1ab31fu;
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

// A corner's noise: a number in [-1, 1], or the product of one of twelve gradients with the vector from the
// corner (Perlin 2002, "Improving Noise").
static inline float corner_noise(u32 h, float x, float y, float z, UNIFORM bool gradient) {
  if (!gradient) return 2.0f * ((float)(int)(h >> 8) * 0x1p-24f) - 1.0f;
  const int k = (int)(h & 15u);
  const float a = k < 8 ? x : y, b = k < 4 ? y : k == 12 || k == 14 ? x : z;
  return ((k & 1) != 0 ? -a : a) + ((k & 2) != 0 ? -b : b);
}

static inline float fade(float f) { return f * f * f * fma(f, fma(f, 6.0f, -15.0f), 10.0f); }

// Noise on the integer lattice, in [-1, 1].
static float lattice_noise(float3 q, UNIFORM bool gradient) {
  const float3 low = (float3)(floor(q.x), floor(q.y), floor(q.z)), f = q - low;
  const int x = (int)low.x, y = (int)low.y, z = (int)low.z;
  float planes[2], rows[2];
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      const float fy = f.y - (float)j, fz = f.z - (float)k;
      const float left = corner_noise(lattice_hash(x, y + j, z + k), f.x, fy, fz, gradient),
                  right = corner_noise(lattice_hash(x + 1, y + j, z + k), f.x - 1.0f, fy, fz, gradient);
      rows[j] = fma(fade(f.x), right - left, left);
    }
    planes[k] = fma(fade(f.y), rows[1] - rows[0], rows[0]);
  }
  return fma(fade(f.z), planes[1] - planes[0], planes[0]);
}

// How much is seen of details of this frequency: none that are finer than the footprint.
static inline float seen_part(UNIFORM float frequency, float w) {
  return real_clamp(2.0f - 2.0f * frequency * w, 0.0f, 1.0f);
}

// Octaves of noise, each twice as fine and `gain` times as strong.
static inline float octave_noise(float3 q, float w, UNIFORM u32 octaves, UNIFORM float gain,
                                 UNIFORM bool gradient) {
  float sum = 0.0f, strength = 1.0f, all = 0.0f, frequency = 1.0f;
  for (u32 i = 0; i < octaves; ++i) {
    const float seen = seen_part(frequency, w);
    if (any(seen > 0.0f)) sum = fma(strength * seen, lattice_noise(q * frequency, gradient), sum);
    all += strength;
    strength *= gain;
    frequency *= 2.0f;
  }
  return sum / fmax(all, 1e-6f);
}

// Distance to the nearest of one point per cell (Worley 1996, "A Cellular Texture Basis Function").
static inline float cell_distance(float3 q, float w) {
  const float3 low = (float3)(floor(q.x), floor(q.y), floor(q.z)), f = q - low;
  const int x = (int)low.x, y = (int)low.y, z = (int)low.z;
  float nearest = 9.0f;
  for (int k = 0; k < 27; ++k) {
    const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
    const u32 h = lattice_hash(x + dx, y + dy, z + dz);
    const float3 to = (float3)((float)dx + (float)(int)(h & 1023u) * (1.0f / 1023.0f) - f.x,
                               (float)dy + (float)(int)(h >> 10 & 1023u) * (1.0f / 1023.0f) - f.y,
                               (float)dz + (float)(int)(h >> 20 & 1023u) * (1.0f / 1023.0f) - f.z);
    nearest = real_min(nearest, dot(to, to));
  }
  return fma(seen_part(1.0f, w), real_min(real_sqrt(nearest), 1.0f) - 0.55f, 0.55f);
}

// Veins: bands across x disturbed by noise (after Perlin 1985, "An Image Synthesizer"; a smoothed triangle
// wave replaces the sine).
static inline float marble_pattern(float3 q, float w, UNIFORM u32 octaves, UNIFORM float gain,
                                   UNIFORM float turbulence) {
  const float x = fma(octave_noise(q, w, octaves, gain, true), turbulence, q.x);
  return fma(seen_part(1.0f, w), smooth_step(fabs(2.0f * fraction(x) - 1.0f)) - 0.5f, 0.5f);
}

// Rings about y, from light to dark and quickly back.
static inline float wood_pattern(float3 q, float w, UNIFORM u32 octaves, UNIFORM float gain,
                                 UNIFORM float turbulence) {
  const float late = 0.85f, r = real_sqrt(fma(q.x, q.x, q.z * q.z));
  const float s = fraction(fma(octave_noise(q, w, octaves, gain, true), turbulence, r));
  const float rising = s * (1.0f / late), t = s > late ? (1.0f - s) / (1.0f - late) : rising * rising;
  return fma(seen_part(1.0f, w), t - 0.36f, 0.36f);
}
