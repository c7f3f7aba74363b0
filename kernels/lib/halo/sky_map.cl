// The map of the sky: the sphere on a square with cells of equal area (Clarberg, "Fast Equal-Area Mapping of
// the (Hemi)Sphere using SIMD", 2008); the upper half is the inner diamond.
#pragma once
#include "lib/halo/crystal.cl"

#ifndef SUNDOG_HOST_LANES
#define HALO_MAP __global u32* restrict
#define HALO_ADD(map, index, units) atomic_add((map) + (index), units)
#endif

// The cells of the directions d, from the ground towards the light.
ALWAYS_INLINE MASK halo_cell(REAL3 d, u32 side) {
  const REAL x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
  const MASK swapped = MASK_OF(x < y);
  const REAL greater = select(x, y, swapped), smaller = select(y, x, swapped);
  const REAL radius = halo_root((x * x + y * y) * halo_inverse(1.0f + z));
  const REAL b = smaller * halo_inverse(real_max(greater, ALL_OF(1e-20f))), w = b * b;
  // Arc tangent in quarter turns, fitted to 1e-6.
  const REAL angle =
      b * (0.63660693f +
           w * (-0.21177506f + w * (0.12329435f + w * (-0.07426241f + w * (0.03362848f - w * 0.00749333f)))));
  const REAL turned = select(angle, 1.0f - angle, swapped) * radius, rest = radius - turned;
  const MASK below = MASK_OF(d.z < 0.0f);
  const REAL u = select(rest, 1.0f - turned, below), v = select(turned, 1.0f - rest, below);
  const float half_side = 0.5f * (float)side, most = (float)side - 0.5f;
  const REAL none = ALL_OF(0.0f);
  const REAL column = half_side + half_side * u * halo_sign(d.x),
             row = half_side + half_side * v * halo_sign(d.y);
  return TO_MASK(real_clamp(row, none, ALL_OF(most))) * (int)side +
         TO_MASK(real_clamp(column, none, ALL_OF(most)));
}

// Adds light leaving the crystals to the cells where observers see it: integer units, rounded randomly, so
// that the mean is exact and little light costs little.
ALWAYS_INLINE void halo_count(const HaloLaunch* launch, HALO_MAP map, HaloRays* rays, const HaloExits* exits,
                              MASK lanes) {
  const MASK units = TO_MASK(exits->weight * HALO_UNITS + halo_random(&rays->random)) & lanes;
  const MASK some = MASK_OF(units > 0);
  if (!any_lane(some)) return;
  const REAL3 d = exits->d;
  const REAL3 seen = real3(0.0f - (d.x * rays->a.x + d.y * rays->b.x + d.z * rays->c.x),
                           0.0f - (d.x * rays->a.y + d.y * rays->b.y + d.z * rays->c.y),
                           0.0f - (d.x * rays->a.z + d.y * rays->b.z + d.z * rays->c.z));
  MASK cell = halo_cell(seen, launch->side), added = units;
  for (u32 i = 0; i < LANES; ++i)
    if (MASK_LANE(added, i) > 0) HALO_ADD(map, MASK_LANE(cell, i), (u32)MASK_LANE(added, i));
}
