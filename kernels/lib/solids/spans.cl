// Entries and exits of lines, and the nearest hit so far on a solid, one ray per lane.
#pragma once
#include "lib/core/config.h"
#include "lib/core/lanes.h"

typedef struct SolidHits {
  REAL t;     // of the hit, else t_max
  REAL3 ng;   // outward, not normalised
  MASK part;  // face or part of the solid
  MASK found;
  HAVING(HAS_LATHE, __global const ProfileArc* profiles;)  // the scene's table
} SolidHits;

// Accepts the hit at t if it is the nearest so far.
static inline void offer(REAL t, REAL3 ng, MASK part, MASK valid, REAL t_min, SolidHits* hits) {
  const MASK nearer = valid & MASK_OF(t > t_min) & MASK_OF(t <= hits->t);
  hits->t = select(hits->t, t, nearer);
  hits->ng = select3(hits->ng, ng, nearer);
  hits->part = select(hits->part, part, nearer);
  hits->found |= nearer;
}

// For a box's face, by axis_face(); finish_faces() computes the normal.
static inline void offer_face(REAL t, MASK face, MASK valid, REAL t_min, SolidHits* hits) {
  const MASK nearer = valid & MASK_OF(t > t_min) & MASK_OF(t <= hits->t);
  hits->t = select(hits->t, t, nearer);
  hits->part = select(hits->part, face, nearer);
  hits->found |= nearer;
}

// w of reach_of_NAME(), which has half sizes of a box around the unit solid: its bounds are that box, or
// round about y within it, or a ball.
#define REACH_BOX 0.0f
#define REACH_ROUND 1.0f
#define REACH_BALL 2.0f

// convexity_of_NAME(): rays from a solid's outside may meet it again; do not; and it is closed, or flat
// without a hole.
#define CONCAVE 0u
#define CONVEX_OUTSIDE 1u
#define CONVEX 2u

static inline REAL3 up_or_down(REAL side) { return real3((REAL)(0.0f), side, (REAL)(0.0f)); }

// Entry and exit of a line.
typedef struct Span {
  REAL enter, leave;
  MASK crosses;
} Span;

// Rays from so far away, in a solid's space, that rounding approaches its size start again at their point
// nearest to its centre: for a solid flattened by 1e-7 all rays are so far. Returns the distance by which
// each moved. Done twice, since the move itself is rounded.
#define FAR_OFF 0x1p14f
static inline REAL come_near(REAL3* o, REAL3 d, MASK active) {
  REAL shift = (REAL)(0.0f);
  MASK far = MASK_OF(dot3(*o, *o) > FAR_OFF * FAR_OFF);
  if (!any_lane(far)) return shift;
  far &= active & MASK_OF(dot3(d, d) > 0.0f);
  for (u32 i = 0; i < 2u; ++i) {
    const REAL way = select((REAL)(0.0f), -dot3(*o, d) / dot3(d, d), far);
    *o = along3(*o, way, d);
    shift += way;
  }
  return shift;
}

// o + t d| = r in the space of the given vectors (2-D if a component is zero in both), robust for
// far origins (Haines et al. 2019, Ray Tracing Gems, chapter 7).
static inline Span round_span(REAL3 o, REAL3 d, float r) {
  const REAL a = dot3(d, d), inverse = 1.0f / a, b = -dot3(o, d);
  const REAL3 nearest = along3(o, b * inverse, d);
  const REAL remaining = r * r - dot3(nearest, nearest);
  Span span;
  span.crosses = MASK_OF(a > 0.0f) & MASK_OF(remaining >= 0.0f);
  const REAL c = dot3(o, o) - r * r;
  const REAL q = b + copysign(real_sqrt(a * remaining), b);
  const REAL t0 = select((REAL)(0.0f), c / q, MASK_OF(q != 0.0f)), t1 = q * inverse;
  span.enter = real_min(t0, t1);
  span.leave = real_max(t0, t1);
  return span;
}
