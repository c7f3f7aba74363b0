// Traces one ray through the two-level BVH, on devices without lists (walk.cl).
#pragma once
#include "lib/core/config.h"
#if !WALKS_IN_TURN
#include "lib/core/motion.cl"
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/trace/hits.cl"
#include "lib/trace/nodes.cl"
#include "lib/trace/triangles.cl"

// Tests the solid `index` in (t_min, hit->t], world-space ray: all lanes hold the same ray.
static inline void trace_solid(const Scene* scene, u32 index, float3 o, float3 d, float t_min, float time,
                               Hit* hit) {
  const REAL3 origins = all3(o), directions = all3(d);
  const REAL starts = (REAL)(t_min);
  Hits hits = no_hits((REAL)(hit->t));
  hits.instance = (MASK)((int)hit->instance);
  set_time_of_hits(scene, (REAL)(time), &hits);
  hit_solids(scene->instances, index, index + 1u, &origins, &directions, &starts, ALL_LANES, false, &hits);
  if ((u32)MASK_LANE(hits.instance, 0) == index) *hit = get_hit(&hits, 0);
}

// Nearest hit in one mesh BVH, or with `any` the first found; o, d in object space. Uses the stack from
// `stack` on. The hit's prim is for finish_triangle.
static inline void trace_mesh(const Scene* scene, u32 root, const SlabRay* slab_ray,
                              const ShearRay* shear_ray, float t_min, u32 instance, bool any, u32* stack,
                              float* stack_t, Hit* found) {
  // Local copies stay in registers.
  const SlabRay slabs = *slab_ray;
  const ShearRay shear = *shear_ray;
  Hit hit = *found;
  u32 top = 0, word = root;
  for (;;) {
    if (word & BVH_LEAF) {
      const u32 first = word & BVH_FIRST_MASK,
                last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      for (u32 i = first; i <= last; ++i) closest_in_block(scene->blocks, i, &shear, t_min, instance, &hit);
      if (any && hit.instance == instance) break;
    } else {
      u32 keys[8];
      const u32 crossed = cross_children(node_at(scene->nodes, word), &slabs, t_min, hit.t, keys);
      if (crossed) {
        word = push_children(node_at(scene->nodes, word), crossed, keys, stack, stack_t, &top);
        continue;
      }
    }
    bool more = false;
    while (top) {
      --top;
      if (!(stack_t[top] > hit.t)) {
        more = true;
        break;
      }
    }
    if (!more) break;
    word = stack[top];
  }
  *found = hit;
}

// Tests one instance in (t_min, hit->t]; world-space ray.
static inline void trace_instance(const Scene* scene, u32 index, float3 o, float3 d, float t_min, float time,
                                  bool any, u32* stack, float* stack_t, Hit* hit) {
  __global const Instance* instance = scene->instances + index;
  if (HAS_MESH && instance->shape == SHAPE_MESH) {
    float3 oo = o, dd = d;
    if (!(instance->flags & INSTANCE_IDENTITY)) {
      oo = object_point(instance, still_point(scene, index, o, time));
      dd = object_vector(instance, still_vector(scene, index, d, time));
    }
    const SlabRay slabs = make_slab_ray(oo, dd);
    const ShearRay shear = make_shear_ray(oo, dd);
    trace_mesh(scene, instance->root, &slabs, &shear, t_min, index, any, stack, stack_t, hit);
    return;
  }
  trace_solid(scene, index, o, d, t_min, time, hit);
}

// Traces the bounded instances below `word` of the scene BVH.
static inline void trace_bounded(const Scene* scene, u32 word, float3 o, float3 d, float t_min, float time,
                                 bool any, Hit* hit) {
  u32 stack[BVH_STACK];
  float stack_t[BVH_STACK];
  const SlabRay slabs = make_slab_ray(o, d);
  u32 top = 0;
  for (;;) {
    if (word & BVH_LEAF) {
      const u32 first = word & BVH_FIRST_MASK,
                last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      for (u32 i = first; i <= last; ++i) {
        trace_instance(scene, i, o, d, t_min, time, any, stack + top, stack_t + top, hit);
        if (any && hit->instance != NO_INSTANCE) return;
      }
    } else {
      u32 keys[8];
      const u32 crossed = cross_children(node_at(scene->nodes, word), &slabs, t_min, hit->t, keys);
      if (crossed) {
        word = push_children(node_at(scene->nodes, word), crossed, keys, stack, stack_t, &top);
        continue;
      }
    }
    do {
      if (!top) return;
      --top;
    } while (stack_t[top] > hit->t);
    word = stack[top];
  }
}

// Traces all bounded instances. A single one is a leaf without a tree, so that instances are traced in one
// place, of which some compilers make copies.
static inline void trace_instances(const Scene* scene, float3 o, float3 d, float t_min, float time, bool any,
                                   Hit* hit) {
  if (scene->info->bounded_count == 0u) return;
  trace_bounded(scene, scene->info->tlas_root, o, d, t_min, time, any, hit);
}

#endif
