// The CPU-class tracer: one ray through the two-level BVH, eight children or eight triangles an instruction.
// In: a ray and the tables. Out: the nearest hit, or whether there is any. This file is the narrow interface
// that shading sees. What is found does not depend on the order of visits.
#ifndef SUNDOG_LIB_TRAVERSE_CL
#define SUNDOG_LIB_TRAVERSE_CL
#include "lib/config.h"
#include "lib/nodes.cl"
#include "lib/solids.cl"
#include "lib/tables.h"
#include "lib/transform.cl"
#include "lib/triangles.cl"

static inline bool finite3(float3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

// A ray with a component that is not finite, or with no direction, hits nothing.
static inline bool traceable(float3 o, float3 d, float t_min, float t_max) {
  return finite3(o) && finite3(d) && t_max > t_min && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f);
}

static inline Hit no_hit(float t_max) {
  const Hit hit = {t_max, 0.0f, 0.0f, NO_PRIM, NO_INSTANCE, 0.0f, 0.0f, 0.0f};
  return hit;
}

#if HAS_MESH
// Nearest hit in one mesh BVH, or with `any` whichever comes first; o, d in object space. Uses the stack from
// `stack` on. A hit's prim is left as finish_triangle wants it.
static inline void trace_mesh(TRACE_PARAMETERS, u32 root, float3 o, float3 d, float t_min, u32 instance,
                              bool any, u32* stack, float* stack_t, Hit* hit) {
  const SlabRay slabs = make_slab_ray(o, d);
  const ShearRay shear = make_shear_ray(o, d);
  u32 top = 0, word = root;
  for (;;) {
    if (word & BVH_LEAF) {
      const u32 first = word & BVH_FIRST_MASK,
                last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      for (u32 i = first; i <= last; ++i) closest_in_block(blocks, i, &shear, t_min, instance, hit);
      if (any && hit->instance == instance) return;
    } else {
      u32 keys[8];
      const u32 crossed = cross_children(nodes + word, &slabs, t_min, hit->t, keys);
      if (crossed) {
        word = any ? push_children_unsorted(nodes + word, crossed, stack, &top)
                   : push_children(nodes + word, crossed, keys, stack, stack_t, &top);
        continue;
      }
    }
    do {
      if (!top) return;
      --top;
    } while (!any && stack_t[top] > hit->t);
    word = stack[top];
  }
}
#endif

static inline void trace_solid(__global const Instance* restrict instances, u32 index, float3 o, float3 d,
                               float t_min, Hit* hit) {
  __global const Instance* instance = instances + index;
  SolidHit solid;
  if (!closest_in_solid(instance->shape, instance->parameters, o, d, t_min, hit->t, &solid)) return;
  if (solid.t == hit->t && hit->instance <= index) return;
  hit->t = solid.t;
  hit->u = 0.0f;
  hit->v = 0.0f;
  hit->prim = solid.part;
  hit->instance = index;
  hit->ng_x = solid.ng.x;
  hit->ng_y = solid.ng.y;
  hit->ng_z = solid.ng.z;
}

// One instance in (t_min, hit->t]; world-space ray.
static inline void trace_instance(TRACE_PARAMETERS, u32 index, float3 o, float3 d, float t_min, bool any,
                                  u32* stack, float* stack_t, Hit* hit) {
  __global const Instance* instance = instances + index;
  const float3 oo = object_point(instance, o), dd = object_vector(instance, d);
#if HAS_MESH
  if (instance->shape == SHAPE_MESH) {
    trace_mesh(TRACE_ARGUMENTS, instance->root, oo, dd, t_min, index, any, stack, stack_t, hit);
    return;
  }
#endif
  trace_solid(instances, index, oo, dd, t_min, hit);
}

// The scene BVH over the bounded instances.
static inline void trace_bounded(TRACE_PARAMETERS, float3 o, float3 d, float t_min, bool any, Hit* hit) {
  u32 stack[BVH_STACK];
  float stack_t[BVH_STACK];
  const SlabRay slabs = make_slab_ray(o, d);
  u32 top = 0, word = info->tlas_root;
  for (;;) {
    if (word & BVH_LEAF) {
      const u32 first = word & BVH_FIRST_MASK,
                last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      for (u32 i = first; i <= last; ++i) {
        trace_instance(TRACE_ARGUMENTS, i, o, d, t_min, any, stack + top, stack_t + top, hit);
        if (any && hit->instance != NO_INSTANCE) return;
      }
    } else {
      u32 keys[8];
      const u32 crossed = cross_children(nodes + word, &slabs, t_min, hit->t, keys);
      if (crossed) {
        word = push_children(nodes + word, crossed, keys, stack, stack_t, &top);
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

static inline void trace_scene(TRACE_PARAMETERS, float3 o, float3 d, float t_min, bool any, Hit* hit) {
  if (info->bounded_count > 0u) trace_bounded(TRACE_ARGUMENTS, o, d, t_min, any, hit);
#if HAS_PLANE
  if (any && hit->instance != NO_INSTANCE) return;
  for (u32 i = info->bounded_count; i < info->instance_count; ++i)
    trace_solid(instances, i, object_point(instances + i, o), object_vector(instances + i, d), t_min, hit);
#endif
}

// The nearest hit in (t_min, t_max]; without one, hit.instance is NO_INSTANCE.
static inline Hit trace_closest(TRACE_PARAMETERS, float3 o, float3 d, float t_min, float t_max) {
  Hit hit = no_hit(t_max);
  if (!traceable(o, d, t_min, t_max)) return hit;
  trace_scene(TRACE_ARGUMENTS, o, d, t_min, false, &hit);
#if HAS_MESH
  if (hit.instance != NO_INSTANCE && instances[hit.instance].shape == SHAPE_MESH)
    finish_triangle(blocks, &hit);
#endif
  return hit;
}

// Whether anything is hit in (t_min, t_max].
static inline bool trace_any(TRACE_PARAMETERS, float3 o, float3 d, float t_min, float t_max) {
  Hit hit = no_hit(t_max);
  if (!traceable(o, d, t_min, t_max)) return false;
  trace_scene(TRACE_ARGUMENTS, o, d, t_min, true, &hit);
  return hit.instance != NO_INSTANCE;
}

// The first `count` (at most BATCH) of rays (o, d) in (t_min, t_max]. `coherent`: they run close together.
static inline void trace_batch(TRACE_PARAMETERS, const float3* o, const float3* d, const float* t_min,
                               const float* t_max, u32 count, bool coherent, Hit* hits) {
  for (u32 i = 0; i < count; ++i) hits[i] = trace_closest(TRACE_ARGUMENTS, o[i], d[i], t_min[i], t_max[i]);
}

// The same for whether anything is hit: occluded[i] becomes 1 or 0.
static inline void occluded_batch(TRACE_PARAMETERS, const float3* o, const float3* d, const float* t_min,
                                  const float* t_max, u32 count, bool coherent, u32* occluded) {
  for (u32 i = 0; i < count; ++i)
    occluded[i] = trace_any(TRACE_ARGUMENTS, o[i], d[i], t_min[i], t_max[i]) ? 1u : 0u;
}

#endif
