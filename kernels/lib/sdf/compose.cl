// Combinations of distance fields. Each operation preserves bounds: if its operands never exceed the distance
// to their surfaces, neither does the result.
#pragma once
#include "lib/sdf/sample.h"

// Table of a transformed field: rows of the rotation's transpose, offset, scale and inverse scale.
static inline REAL3 into_child(REAL3 p, SDF_TABLE q) {
  const REAL3 d = real3((p.x - q[9]) * q[13], (p.y - q[10]) * q[13], (p.z - q[11]) * q[13]);
  return real3(fma(d.x, (REAL)(q[0]), fma(d.y, (REAL)(q[1]), d.z * q[2])),
               fma(d.x, (REAL)(q[3]), fma(d.y, (REAL)(q[4]), d.z * q[5])),
               fma(d.x, (REAL)(q[6]), fma(d.y, (REAL)(q[7]), d.z * q[8])));
}
static inline REAL3 out_of_child(REAL3 g, SDF_TABLE q) {
  return real3(fma(g.x, (REAL)(q[0]), fma(g.y, (REAL)(q[3]), g.z * q[6])),
               fma(g.x, (REAL)(q[1]), fma(g.y, (REAL)(q[4]), g.z * q[7])),
               fma(g.x, (REAL)(q[2]), fma(g.y, (REAL)(q[5]), g.z * q[8])));
}

static inline REAL out_of_child_distance(REAL d, SDF_TABLE q) { return d * q[12]; }
static inline SdfSample out_of_child_sample(SdfSample s, SDF_TABLE q) {
  SdfSample out = s;
  out.distance *= q[12];
  out.gradient = out_of_child(s.gradient, q);
  return out;
}

// Position in the nearest cell (neighbour = 0) or the next nearest along the axis, so that a child that fits
// its cell is never missed. Table: three periods, three counts.
static inline REAL cell_coordinate(REAL x, SCALAR period, SCALAR count, u32 neighbour) {
  if (!(period > 0.0f)) return x;
  const REAL cell = floor(x / period + 0.5f), inside = x - cell * period;
  const REAL next = cell + select((REAL)(-1.0f), (REAL)(1.0f), MASK_OF(inside > 0.0f));
  REAL chosen = neighbour ? next : cell;
  if (count > 0.0f) chosen = clamp(chosen, (REAL)(-count), (REAL)(count));
  return x - chosen * period;
}
static inline REAL3 repeat_cell(REAL3 p, SDF_TABLE q, u32 neighbours) {
  return real3(cell_coordinate(p.x, q[0], q[3], neighbours & 1u),
               cell_coordinate(p.y, q[1], q[4], neighbours & 2u),
               cell_coordinate(p.z, q[2], q[5], neighbours & 4u));
}

// The smooth minimum of a and b, and b's share of it: quadratic, equal to the plain minimum if they differ by
// k.
static inline REAL smooth_minimum(REAL a, REAL b, SCALAR k, REAL* share) {
  const REAL h = fmax(1.0f - fabs(a - b) / k, (REAL)(0.0f));
  const REAL less = 0.5f * h;
  const MASK second = MASK_OF(b < a);
  *share = select(less, 1.0f - less, second);
  return real_min(a, b) - h * h * (0.25f * k);
}

static inline REAL unite(REAL a, REAL b, SCALAR smooth) {
  if (!(smooth > 0.0f)) return real_min(a, b);
  REAL share;
  return smooth_minimum(a, b, smooth, &share);
}
static inline REAL intersect(REAL a, REAL b, SCALAR smooth) { return -unite(-a, -b, smooth); }
static inline REAL subtract_from(REAL a, REAL b, SCALAR smooth) { return -unite(-a, b, smooth); }

static inline SdfSample negated_sample(SdfSample a) {
  SdfSample negated = a;
  negated.distance = -a.distance;
  negated.gradient = negate3(a.gradient);
  return negated;
}
// Exact for closed forms, whose gradients are those of their distances; not used for fractals.
static inline SdfSample unite_samples(SdfSample a, SdfSample b, SCALAR smooth) {
  SdfSample r = select_sample(a, b, MASK_OF(b.distance < a.distance));
  if (!(smooth > 0.0f)) return r;
  REAL share;
  r.distance = smooth_minimum(a.distance, b.distance, smooth, &share);
  r.gradient = along3(scale3(a.gradient, 1.0f - share), share, b.gradient);
  return r;
}
static inline SdfSample intersect_samples(SdfSample a, SdfSample b, SCALAR smooth) {
  return negated_sample(unite_samples(negated_sample(a), negated_sample(b), smooth));
}
static inline SdfSample subtract_samples(SdfSample a, SdfSample b, SCALAR smooth) {
  return negated_sample(unite_samples(negated_sample(a), b, smooth));
}

static inline REAL thicken(REAL d, SCALAR amount) { return d - amount; }
static inline REAL shell(REAL d, SCALAR amount) { return fabs(d) - 0.5f * amount; }
static inline SdfSample thicken_sample(SdfSample s, SCALAR amount) {
  SdfSample thick = s;
  thick.distance -= amount;
  return thick;
}
static inline SdfSample shell_sample(SdfSample s, SCALAR amount) {
  SdfSample shell = select_sample(s, negated_sample(s), MASK_OF(s.distance < 0.0f));
  shell.distance -= 0.5f * amount;
  return shell;
}
