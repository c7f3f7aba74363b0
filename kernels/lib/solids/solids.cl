// The exact solids in object space, one ray or point per lane. Each row of shared/shapes.h has five
// functions: closest_in_NAME() offers hits, nearest t in (t_min, t_max] with the outward normal (directions
// need not be unit); points_on_NAME() gives coordinates, curvature_of_NAME() the mean curvature of a point.
// For shafts, reach_of_NAME() gives its bounds, and convexity_of_NAME() whether rays from it meet it again.
#pragma once
#include "lib/solids/boxes.cl"
#include "lib/solids/lathe.cl"
#include "lib/solids/round.cl"
#include "lib/solids/torus.cl"
#include "shared/bvh.h"

// The nearest hits of the lanes of `active` in (t_min, hits->t]; sets `found`, and the other members if there
// is one.
ALWAYS_INLINE void closest_in_solid(u32 shape, float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                    SolidHits* hits) {
#define CLOSEST(constant, type, name, effect) \
  case SHAPE_##constant:                      \
    HAVING(HAS_##constant, closest_in_##name(parameters, o, d, t_min, active, hits);) break;
  switch (shape) {
    SOLIDS(CLOSEST)
    default:
      break;
  }
#undef CLOSEST
}

// Coordinates of points p on the `part`s of a solid; `at` is unchanged for other shapes. The part of lanes
// that are off is negative.
static inline void points_on_solid(const Scene* scene, u32 shape, float4 parameters, REAL3 p, MASK part,
                                   MASK lanes, SurfacePoints* at) {
  part = select((MASK)(-1), part, lanes);
#define POINTS(constant, type, name, effect) \
  HAVING(                                    \
      HAS_##constant,                        \
      if (shape == SHAPE_##constant) { *at = points_on_##name(scene, parameters, p, part); })
  SOLIDS(POINTS)
#undef POINTS
}

// Mean curvature of unit shapes at points p.
static inline REAL solid_curvatures(const Scene* scene, u32 shape, float4 parameters, REAL3 p, MASK part,
                                    MASK lanes) {
  part = select((MASK)(-1), part, lanes);
#define CURVATURES(constant, type, name, effect) \
  HAVING(HAS_##constant,                         \
         if (shape == SHAPE_##constant) return curvature_of_##name(scene, parameters, p, part);)
  SOLIDS(CURVATURES)
#undef CURVATURES
  return (REAL)(0.0f);
}

static inline float4 solid_reach(u32 shape, float4 parameters) {
#define REACH(constant, type, name, effect) \
  if (HAS_##constant && shape == SHAPE_##constant) return reach_of_##name(parameters);
  SOLIDS(REACH)
#undef REACH
  return (float4)(0.0f);
}

static inline u32 solid_convexity(u32 shape, float4 parameters) {
#define CONVEXITY(constant, type, name, effect) \
  if (HAS_##constant && shape == SHAPE_##constant) return convexity_of_##name(parameters);
  SOLIDS(CONVEXITY)
#undef CONVEXITY
  return CONCAVE;
}
