// Tests whether anything may occlude a light: a shaft (Haines and Wallace 1991, "Shaft Culling for Efficient
// Ray-Traced Radiosity") is a pyramid from a point to the corners of the light's bounds, one point per lane.
// In: shafts and a scene of few instances. Out: the instances that some shaft may touch. Lanes that touch
// none are unoccluded; the reverse does not hold.
#pragma once
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/solids/solids.cl"
#include "lib/trace/hits.cl"

#if HAS_SHAFTS
// Relative enlargement of a solid's bounds, for rounding of rays that hit it.
#define SHAFT_MARGIN 1e-3f

typedef struct Shafts {
  REAL3 o;        // origin of the shadow rays
  REAL3 edge[4];  // from there to the corners, in order
  REAL slack;     // bound of rounding errors of o
  MASK outside;   // the instance on whose outside o lies, or NO_INSTANCE
} Shafts;

// Support of `reach` (solid_reach()) along n, which need not be unit.
static inline REAL reach_along(float4 reach, REAL3 n) {
  if (reach.w == REACH_BALL) return reach.x * length3(n);
  const REAL up = reach.y * fabs(n.y);
  if (reach.w == REACH_ROUND) return fma((REAL)(reach.x), real_sqrt(fma(n.x, n.x, n.z * n.z)), up);
  return fma((REAL)(reach.x), fabs(n.x), fma((REAL)(reach.z), fabs(n.z), up));
}

// Whether the whole shaft is beyond `reach` on one side of 0, along an axis.
static inline MASK beyond(REAL o, REAL a, REAL b, REAL c, REAL d, REAL reach) {
  const REAL zero = (REAL)(0.0f);
  const REAL low = real_min(real_min(zero, a), real_min(b, real_min(c, d))),
             high = real_max(real_max(zero, a), real_max(b, real_max(c, d)));
  return MASK_OF(o + low > reach) | MASK_OF(o + high < -reach);
}

// Whether a plane through o with normal n, towards which the shaft lies if `within` is above 0, separates it
// from `reach`. All in that space.
static inline MASK parted(REAL3 o, REAL3 n, REAL within, float4 reach, REAL pad) {
  const REAL most = reach_along(reach, n) + pad * (fabs(n.x) + fabs(n.y) + fabs(n.z));
  const REAL away = dot3(n, o);
  return (MASK_OF(within > 0.0f) & MASK_OF(away > most)) | (MASK_OF(within < 0.0f) & MASK_OF(-away > most));
}

// The lanes of `lanes` whose shafts, with origin o and edges e in the space of `reach`, may touch it: neither
// its sides, nor the shaft's, nor the light's plane separate them.
static inline MASK may_touch_solid(REAL3 o, const REAL3* e, float4 reach, REAL pad, MASK lanes) {
  lanes &= ~beyond(o.x, e[0].x, e[1].x, e[2].x, e[3].x, reach.x + pad);
  lanes &= ~beyond(o.y, e[0].y, e[1].y, e[2].y, e[3].y, reach.y + pad);
  lanes &= ~beyond(o.z, e[0].z, e[1].z, e[2].z, e[3].z, reach.z + pad);
  if (!any_lane(lanes)) return lanes;
#pragma unroll
  for (u32 i = 0; i < 4u; ++i) {
    const REAL3 n = cross3(e[i], e[(i + 1u) & 3u]);
    lanes &= ~parted(o, n, dot3(n, add3(e[(i + 2u) & 3u], e[(i + 3u) & 3u])), reach, pad);
  }
  const REAL3 front = cross3(subtract3(e[1], e[0]), subtract3(e[2], e[0]));
  return lanes & ~parted(add3(o, e[0]), front, -dot3(front, e[0]), reach, pad);
}

// The lanes of `lanes` whose shafts may touch the ball (center, radius) in world space.
static inline MASK may_touch_ball(const Shafts* shafts, float4 ball, MASK lanes) {
  const REAL3 o = subtract3(shafts->o, all3(ball.xyz));
  return may_touch_solid(o, shafts->edge, (float4)(ball.w, ball.w, ball.w, REACH_BALL),
                         shafts->slack + SHAFT_MARGIN * ball.w, lanes);
}

// The lanes of `lanes` whose shafts may touch the solid `index`. A convex solid occludes nothing on its own
// outside: light from below the tangent plane does not count there.
static inline MASK may_touch_instance(const Scene* scene, u32 index, const Shafts* shafts, MASK lanes) {
  __global const Instance* instance = scene->instances + index;
  if (HAS_MESH && instance->shape == SHAPE_MESH) return may_touch_ball(shafts, instance->world_center, lanes);
  if (solid_convexity(instance->shape, instance->parameters) != CONCAVE)
    lanes &= MASK_OF(shafts->outside != (int)index);
  if (!any_lane(lanes)) return lanes;
  const float4 x = instance->object_from_world[0], y = instance->object_from_world[1],
               z = instance->object_from_world[2];
  const float scale = fmax(length(x.xyz), fmax(length(y.xyz), length(z.xyz)));
  const REAL3 o = object_points(instance, shafts->o);
  const REAL3 e[4] = {object_vectors(instance, shafts->edge[0]), object_vectors(instance, shafts->edge[1]),
                      object_vectors(instance, shafts->edge[2]), object_vectors(instance, shafts->edge[3])};
  const REAL pad = scale * shafts->slack;
  if (HAS_PLANE && instance->shape == SHAPE_PLANE)
    return lanes & ~beyond(o.y, e[0].y, e[1].y, e[2].y, e[3].y, pad);
  return may_touch_solid(o, e, solid_reach(instance->shape, instance->parameters), pad + SHAFT_MARGIN, lanes);
}

// The points o outside a box around a solid that is convex and closed, or flat.
static inline MASK outside_convex(__global const Instance* instance, REAL3 o) {
  const u32 shape = instance->shape;
  const float4 parameters = instance->parameters;
  if (shape == SHAPE_PLANE) return ALL_LANES;
  if (solid_convexity(shape, parameters) != CONVEX) return NO_LANES;
  const REAL3 p = object_points(instance, o);
  const float4 reach = solid_reach(shape, parameters);
  return MASK_OF(fabs(p.x) > reach.x) | MASK_OF(fabs(p.y) > reach.y) | MASK_OF(fabs(p.z) > reach.z);
}

// Whether the instance is the light's own visible shape, which does not occlude it.
static inline bool shows_light(const Scene* scene, __global const Instance* instance, u32 light) {
  return instance->light == light && instance->shape != SHAPE_MESH;
}

// The instances that the shafts of `lanes` to the light `light` may touch: lanes that touch only opaque
// solids go to `soft`, with a bit in `solids` for each of these; lanes that touch anything else to `hard`.
NEVER_INLINE void cast_shafts(const Scene* scene, u32 light, const Shafts* shafts, MASK lanes, MASK* soft,
                              MASK* hard, u32* solids) {
  *soft = *hard = NO_LANES;
  *solids = 0;
  for (u32 i = 0; i < scene->info->instance_count; ++i) {
    __global const Instance* instance = scene->instances + i;
    if (shows_light(scene, instance, light)) continue;
    const MASK touched = may_touch_instance(scene, i, shafts, lanes);
    if (!any_lane(touched)) continue;
    if (instance->shape == SHAPE_MESH || (instance->flags & INSTANCE_FILTERS)) {
      *hard |= touched;
    } else {
      *soft |= touched;
      *solids |= 1u << i;
    }
  }
  *soft &= ~*hard;
}

// The lanes of `lanes` whose ways (o, d) meet one of `solids` before `t_max`.
static inline MASK blocked_by(const Scene* scene, u32 solids, REAL3 o, REAL3 d, REAL t_max, MASK lanes) {
  Hits hits = no_hits(t_max);
  prepare_hits(scene, (REAL)(0.0f), &hits);  // shafts know nothing that moves
  const REAL t_min = (REAL)(0.0f);
  for (; HAS_SOLID && solids; solids &= solids - 1u) {
    const u32 i = lowest_bit(solids);
    hit_solids(scene->instances, (uint2)(i, i + 1u), &o, &d, &t_min, lanes, TRACE_ANY, &hits);
  }
  return lanes & hit_anything(&hits);
}
#endif
