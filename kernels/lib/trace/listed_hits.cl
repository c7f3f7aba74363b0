// All hits of rays to a light in one walk: each surface that may transmit light (multi-hit traversal,
// Gribble, Naveros and Kerzner 2014), and any opaque one. A ray through four interfaces is walked once, not
// five times.
#pragma once
#include "lib/core/config.h"
#include "lib/core/tables.h"
#include "lib/trace/hits.cl"
#include "lib/trace/triangles.cl"

#define LISTS_HITS (WALKS_IN_TURN && HAS_MESH && (HAS_SHADOW_FILTERS || HAS_MEDIA) && !HAS_SDF && BATCH > 1)

// The nearest are kept if there are more.
#define MOST_LISTED 8u

// The triangles that a ray hit, unordered; `place` as in finish_triangle().
typedef struct HitList {
  u32 count;
  bool full;  // there may be more hits behind the farthest
  float t[MOST_LISTED], u[MOST_LISTED], v[MOST_LISTED];
  u32 place[MOST_LISTED], instance[MOST_LISTED];
} HitList;

// Rays by lane; in walks hits->t is their end.
typedef struct TraceRays {
  const REAL3 *o, *d;
  const REAL* t_min;
  Hits* hits;
  HitList* lists;          // one list per ray of the hits that do not end it; 0: find the nearest hit
  const MASK* priorities;  // of the rays' media: hits of lower priority are listed; 0: all hits that may
                           // transmit light
} TraceRays;

// The lanes of `lanes` whose hits are opaque.
static inline MASK opaque_hits(__global const Instance* restrict instances, const Hits* hits, MASK lanes) {
  MASK found = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes & hit_anything(hits)); left;) {
    const MASK mine = take_alike(hits->instance, &left, &index);
    if (!(instances[index].flags & INSTANCE_FILTERS)) found |= mine;
  }
  return found;
}

#if WALKS_IN_TURN
static inline void clear_list(HitList* list) {
  list->count = 0;
  list->full = false;
}

static inline u32 farthest_listed(const HitList* list) {
  u32 farthest = 0;
  for (u32 k = 1; k < list->count; ++k)
    if (list->t[k] > list->t[farthest]) farthest = k;
  return farthest;
}

static inline void add_listed(HitList* list, float t, float u, float v, u32 place, u32 instance) {
  u32 at = list->count;
  if (at < MOST_LISTED) {
    ++list->count;
  } else {
    at = farthest_listed(list);
    list->full = true;
    if (t >= list->t[at]) return;
  }
  list->t[at] = t;
  list->u[at] = u;
  list->v[at] = v;
  list->place[at] = place;
  list->instance[at] = instance;
}

// Whether rays in a medium of `priority` do not see the instance, because its own medium's priority is lower.
static inline bool is_overruled(const Scene* scene, u32 index, int priority) {
  __global const Instance* instance = scene->instances + index;
  if (!(instance->flags & INSTANCE_TRANSMITS) || instance->material == NO_MATERIAL || instance->touch > 0.0f)
    return false;
  __global const Material* material = scene->materials + instance->material;
  return (material->flags & (MATERIAL_TRANSMITS | MATERIAL_THIN)) == MATERIAL_TRANSMITS &&
         scene->media[material->medium].priority < priority;
}

// Lists all hits of a block in the mesh of `instance`. Returns the remaining t_max.
static inline float list_block(u32 index, const BlockTest* test, u32 instance, float t_max, HitList* list) {
  float t[8], u[8], v[8];
  vstore8(test->t, 0, t);
  vstore8(test->u, 0, u);
  vstore8(test->v, 0, v);
  for (u32 lanes = test->lanes; lanes; lanes &= lanes - 1u) {
    const u32 i = lowest_bit(lanes);
    add_listed(list, t[i], u[i], v[i], index * 8u + i, instance);
  }
  return list->full ? list->t[farthest_listed(list)] : t_max;
}

// Replaces *hit by the nearest listed hit behind t_min if that comes first. Returns whether it does.
static inline bool take_nearest(__global const TriangleBlock* restrict blocks, const HitList* list,
                                float t_min, Hit* hit) {
  bool taken = false;
  for (u32 k = 0; k < list->count; ++k) {
    const float t = list->t[k];
    if (!(t > t_min) || t > hit->t) continue;
    if (t == hit->t && !wins_tie(blocks, list->instance[k], list->place[k], hit)) continue;
    hit->t = t;
    hit->u = list->u[k];
    hit->v = list->v[k];
    hit->prim = list->place[k];
    hit->instance = list->instance[k];
    taken = true;
  }
  return taken;
}
#endif
