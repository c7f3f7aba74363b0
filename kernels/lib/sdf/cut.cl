// The interval of a field: a box, optionally a sphere, that bounds the march and cuts the surface.
#pragma once
#include "lib/sdf/sample.h"

// Clips to one slab. A parallel ray is always or never inside (avoids 0 times infinity).
static inline void clip_slab(REAL o, REAL d, float lower, float upper, REAL* enter, REAL* leave) {
  const MASK parallel = MASK_OF(fabs(d) < 1e-30f);
  const REAL inverse = 1.0f / nonzero(d);
  const REAL a = (lower - o) * inverse, b = (upper - o) * inverse;
  const MASK within = MASK_OF(o >= lower) & MASK_OF(o <= upper);
  const REAL near = select(fmin(a, b), select((REAL)(INFINITY), (REAL)(-INFINITY), within), parallel);
  const REAL far = select(fmax(a, b), select((REAL)(-INFINITY), (REAL)(INFINITY), within), parallel);
  *enter = fmax(*enter, near);
  *leave = fmin(*leave, far);
}

// Narrows [enter, leave] to the interval; empty (enter > leave) if the ray misses it.
static inline void clip_to_interval(__global const SdfField* restrict field, REAL3 o, REAL3 d, REAL* enter,
                                    REAL* leave) {
  clip_slab(o.x, d.x, field->lower.x, field->upper.x, enter, leave);
  clip_slab(o.y, d.y, field->lower.y, field->upper.y, enter, leave);
  clip_slab(o.z, d.z, field->lower.z, field->upper.z, enter, leave);
  if (!(field->flags & SDF_FLAGS & SDF_CUT_SPHERE)) return;
  const REAL3 c =
      subtract3(o, real3((REAL)(field->sphere.x), (REAL)(field->sphere.y), (REAL)(field->sphere.z)));
  const REAL a = dot3(d, d), middle = -dot3(c, d) / a;
  const REAL3 nearest = along3(c, middle, d);  // its distance from the centre avoids cancellation
  const REAL square = fma((REAL)(field->sphere.w), (REAL)(field->sphere.w), -dot3(nearest, nearest)) / a;
  const REAL half_chord = real_sqrt(fmax(square, 0.0f));
  const MASK missed = MASK_OF(square < 0.0f);
  *enter = select(fmax(*enter, middle - half_chord), (REAL)(INFINITY), missed);
  *leave = select(fmin(*leave, middle + half_chord), (REAL)(-INFINITY), missed);
}

// Outward normal of the cut at p: of the nearest face, or of the sphere.
static inline REAL3 cut_normal(__global const SdfField* restrict field, REAL3 p) {
  const float4 center = 0.5f * (field->lower + field->upper),
               half_size = 0.5f * (field->upper - field->lower);
  const REAL3 c = real3(p.x - center.x, p.y - center.y, p.z - center.z);
  const REAL x = fabs(c.x) - half_size.x, y = fabs(c.y) - half_size.y, z = fabs(c.z) - half_size.z;
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const MASK on_x = MASK_OF(x >= y) & MASK_OF(x >= z), on_y = MASK_OF(y >= z) & ~on_x;
  REAL3 n = real3(select(zero, copysign(one, c.x), on_x), select(zero, copysign(one, c.y), on_y),
                  select(copysign(one, c.z), zero, on_x | on_y));
  if (!(field->flags & SDF_FLAGS & SDF_CUT_SPHERE)) return n;
  const REAL3 radial =
      subtract3(p, real3((REAL)(field->sphere.x), (REAL)(field->sphere.y), (REAL)(field->sphere.z)));
  return select3(n, unit3(radial), MASK_OF(length3(radial) - field->sphere.w > fmax(x, fmax(y, z))));
}
