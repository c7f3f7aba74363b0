// Hits of a batch, one ray per lane, and tests of exact solids.
#pragma once
#include "lib/core/config.h"
#include "lib/core/lanes.h"
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/core/turns.cl"
#include "lib/solids/solids.cl"

// How to trace rays.
#define TRACE_NEAREST 0u   // to the nearest hit
#define TRACE_ANY 1u       // to any hit
#define TRACE_COHERENT 2u  // the rays are coherent
#define TRACE_APART 4u     // to solids that a scene with meshes does not have in its BVH: no lathes

// The members of Hit; without a hit, `instance` is -1 (NO_INSTANCE) and t the ray's t_max.
typedef struct Hits {
  REAL t, u, v;
  MASK prim, instance;
  REAL3 ng;
  HAVING(HAS_OBJECT_MOTION, REAL time;)                     // of the ray
  HAVING(HAS_OBJECT_MOTION, __global const float4* moves;)  // the scene's tables
  HAVING(HAS_TURNS, __global const Turn* turns;)
  HAVING(HAS_LATHE, __global const ProfileArc* profiles;)
} Hits;

static inline Hits no_hits(REAL t_max) {
  const REAL zero = (REAL)(0.0f);
  const Hits hits = {.t = t_max,
                     .u = zero,
                     .v = zero,
                     .prim = (MASK)((int)NO_PRIM),
                     .instance = (MASK)((int)NO_INSTANCE),
                     .ng = {zero, zero, zero}};
  return hits;
}

// The tables and times of rays' hits; their origins and directions moved with instance `index` back to when
// the shutter opened (core/motion.cl); solids_origins(): each lane of `bits` with its own instance.
static inline REAL time_of_hits(const Hits* hits) {
  return EITHER(HAS_OBJECT_MOTION, hits->time, (REAL)(0.0f));
}
static inline void prepare_hits(const Scene* scene, REAL time, Hits* hits) {
  HAVING(HAS_OBJECT_MOTION, hits->time = time; hits->moves = scene->moves;)
  HAVING(HAS_TURNS, hits->turns = scene->turns;)
  HAVING(HAS_LATHE, hits->profiles = scene->profiles;)
}
static inline REAL3 still_origins(const Hits* hits, u32 index, REAL3 o) {
  HAVING(HAS_TURNS, return unturned_points(hits->turns, hits->moves[index], o, hits->time);)
  HAVING(HAS_OBJECT_MOTION, return along3(o, -hits->time, all3(hits->moves[index].xyz));)
  return o;
}
static inline REAL3 still_directions(const Hits* hits, u32 index, REAL3 d) {
  return EITHER(HAS_TURNS, unturned_vectors(hits->turns, hits->moves[index], d, hits->time), d);
}
static inline REAL3 solids_origins(const Hits* hits, const u32* solids, u32 bits, REAL3 o) {
  if (!HAS_OBJECT_MOTION) return o;
  REAL3 still = o;
  for (; HAS_TURNS && bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    still = select3(still, still_origins(hits, solids[i], o), lanes_of(1u << i));
  }
  if (HAS_TURNS) return still;
  REAL3 moved = all3((float3)(0.0f));
  for (; bits; bits &= bits - 1u) {
    HAVING(HAS_OBJECT_MOTION, set3(&moved, lowest_bit(bits), hits->moves[solids[lowest_bit(bits)]].xyz);)
  }
  return along3(o, -time_of_hits(hits), moved);
}
static inline REAL3 solids_directions(const Hits* hits, const u32* solids, u32 bits, REAL3 d) {
  REAL3 still = d;
  for (; HAS_TURNS && bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    still = select3(still, still_directions(hits, solids[i], d), lanes_of(1u << i));
  }
  return still;
}
static inline MASK hit_anything(const Hits* hits) { return MASK_OF(hits->instance != (int)NO_INSTANCE); }

static inline Hit get_hit(const Hits* hits, u32 i) {
  const Hit hit = {REAL_LANE(hits->t, i),
                   REAL_LANE(hits->u, i),
                   REAL_LANE(hits->v, i),
                   (u32)MASK_LANE(hits->prim, i),
                   (u32)MASK_LANE(hits->instance, i),
                   REAL_LANE(hits->ng.x, i),
                   REAL_LANE(hits->ng.y, i),
                   REAL_LANE(hits->ng.z, i)};
  return hit;
}

static inline void set_hit(Hits* hits, u32 i, const Hit* hit) {
  REAL_LANE(hits->t, i) = hit->t;
  REAL_LANE(hits->u, i) = hit->u;
  REAL_LANE(hits->v, i) = hit->v;
  MASK_LANE(hits->prim, i) = (int)hit->prim;
  MASK_LANE(hits->instance, i) = (int)hit->instance;
  set3(&hits->ng, i, (float3)(hit->ng_x, hit->ng_y, hit->ng_z));
}

// The lanes of `m` become those of `other`.
static inline void join_hits(Hits* hits, const Hits* other, MASK m) {
  hits->t = select(hits->t, other->t, m);
  hits->u = select(hits->u, other->u, m);
  hits->v = select(hits->v, other->v, m);
  hits->prim = select(hits->prim, other->prim, m);
  hits->instance = select(hits->instance, other->instance, m);
  hits->ng = select3(hits->ng, other->ng, m);
  HAVING(HAS_OBJECT_MOTION, hits->time = select(hits->time, other->time, m); hits->moves = other->moves;)
  HAVING(HAS_TURNS, hits->turns = other->turns;)
  HAVING(HAS_LATHE, hits->profiles = other->profiles;)
}

// Solids offer hits in (t_min, t], where t is the distance of the hit so far; at equal distances the lower
// index wins, so after a hit on an index up to `index` the interval ends at the next lower float. Distances
// are not negative, so neighbouring floats are neighbouring integers.
static inline REAL number_below(REAL t) { return AS_REAL(AS_MASK(t) - 1); }
static inline REAL number_above(REAL t) { return AS_REAL(AS_MASK(t) + 1); }
static inline SolidHits begin_solids(const Hits* hits, MASK index) {
  const MASK earlier = hit_anything(hits) & MASK_OF(hits->instance <= index);
  SolidHits solid;
  solid.t = select(hits->t, number_below(hits->t), earlier);
  solid.ng = hits->ng;
  solid.part = solid.found = NO_LANES;
  HAVING(HAS_LATHE, solid.profiles = hits->profiles;)
  return solid;
}

// The lanes of `found` take the hits that solids offered; their instances are set already.
static inline void take_solids(SolidHits* solid, MASK found, Hits* hits) {
  const REAL zero = (REAL)(0.0f);
  finish_faces(found, solid);
  hits->t = select(hits->t, solid->t, found);
  hits->u = select(hits->u, zero, found);
  hits->v = select(hits->v, zero, found);
  hits->prim = select(hits->prim, solid->part, found);
  hits->ng = select3(hits->ng, solid->ng, found);
}

// Tests solids of a shape, `index` per lane, in (t_min, hits->t] for lanes of `active`; rays in object space.
ALWAYS_INLINE void offer_solids(u32 shape, float4 parameters, MASK index, REAL3 o, REAL3 d, REAL t_min,
                                MASK active, Hits* hits) {
  SolidHits solid = begin_solids(hits, index);
  closest_in_solid(shape, parameters, o, d, t_min, active, &solid);
  if (!any_lane(solid.found)) return;
  hits->instance = select(hits->instance, index, solid.found);
  take_solids(&solid, solid.found, hits);
}

// Tests the instances from range.x up to, but not, range.y, all solids, for the lanes of `active`;
// world-space rays, whose hits so far are on other instances or on the first. `way`: TRACE_* bits; with
// TRACE_ANY, lanes with a hit are done, and only their instance is set. The loop is in this function to keep
// rays and hits in registers.
NEVER_INLINE void hit_solids(__global const Instance* restrict instances, uint2 range, const REAL3* rays_o,
                             const REAL3* rays_d, const REAL* rays_t_min, MASK active, u32 way, Hits* hits) {
  const REAL3 o = *rays_o, d = *rays_d;
  const REAL t_min = *rays_t_min;
  SolidHits solid = begin_solids(hits, (MASK)((int)range.x));
  MASK found = NO_LANES, nearest = hits->instance;
  for (u32 i = range.x; i < range.y; ++i) {
    if (way & TRACE_ANY) active &= ~found;
    if (!any_lane(active)) break;
    __global const Instance* instance = instances + i;
    const u32 shape = instance->shape;
    if (HAS_LATHE && (way & TRACE_APART) && shape == SHAPE_LATHE) continue;  // for compilers that inline
    REAL3 origins = still_origins(hits, i, o), directions = still_directions(hits, i, d);
    into_object(instance, &origins, &directions);
    solid.found = NO_LANES;
    closest_in_solid(shape, instance->parameters, origins, directions, t_min, active, &solid);
    nearest = select(nearest, (MASK)((int)i), solid.found);
    solid.t = select(solid.t, number_below(solid.t), solid.found);
    found |= solid.found;
  }
  if (!any_lane(found)) return;
  hits->instance = nearest;
  if (way & TRACE_ANY) return;
  solid.t = number_above(solid.t);
  take_solids(&solid, found, hits);
}
