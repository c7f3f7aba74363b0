// Traces one ray through both levels of the BVH, on devices without lists (walk.cl): one loop, and a stack of
// eight bytes a level, because a GPU keeps the stack in memory and pays for every register.
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
  prepare_hits(scene, (REAL)(time), &hits);
  hit_solids(scene->instances, (uint2)(index, index + 1u), &origins, &directions, &starts, ALL_LANES,
             TRACE_NEAREST, &hits);
  // A thin solid may be in several leaves: it may be the nearest hit already.
  const bool nearer = hit->instance != index || REAL_LANE(hits.t, 0) < hit->t;
  if ((u32)MASK_LANE(hits.instance, 0) == index && nearer) *hit = get_hit(&hits, 0);
}

#if !WIDE_VECTORS
// A ray in the space in which it is traced. Tests of boxes and triangles make their other values from it,
// which costs less than keeping them in registers.
typedef struct LeanRay {
  float3 o, d, rcp;  // rcp: safe_reciprocal(d)
} LeanRay;

static inline LeanRay lean_ray(float3 o, float3 d) {
  const LeanRay ray = {o, d, safe_reciprocal(d)};
  return ray;
}

// An entry of the stack: a node and the slots of its waiting children, nearest first, three bits each below a
// final 1. Or, by the second number, WAITING_WORD: a word to visit; WAITING_RAY: the ray in world space lies
// in the three entries below.
#define WAITING_WORD 0u
#define WAITING_RAY 0xFFFFFFFFu
#define NO_CHILDREN 1u

// How a node's eight boxes are tested. 0: unrolled. 1: unrolled, the node read 16 bytes at a time. 2: four at
// a time in a loop, for fewer registers.
#ifndef NODE_LOOP
#define NODE_LOOP 0
#endif

// The children that the ray enters in [t_min, t_max], as a list of slots.
ALWAYS_INLINE u32 crossed_children(__global const BvhNode* node, const LeanRay* ray, float t_min,
                                   float t_max) {
#if NODE_LOOP == 1
  __global const uint4* pieces = (__global const uint4*)node;
  const uint4 head = pieces[0], a = pieces[2], b = pieces[3], c = pieces[4], d = pieces[5];
  const u32 planes[12] = {a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, d.x, d.y};
  const float3 origin = as_float3(head.xyz);
  const u32 scale = head.w;
#else
  __global const u32* planes = node->quantized;
  const float3 origin = (float3)(node->origin[0], node->origin[1], node->origin[2]);
  const u32 scale = node->scale;
#endif
  const float3 rcp_near = ray->rcp * NEARER, rcp_far = ray->rcp * FARTHER, away = origin - ray->o;
  const float3 step = grid_step(scale), step_near = step * rcp_near, step_far = step * rcp_far;
  float3 near_from = away * rcp_near, far_from = away * rcp_far;
  const float3 slack = along_face(rcp_near);
  near_from -= fma(fabs(near_from), (float3)(3.6e-7f), slack);
  far_from += fma(fabs(far_from), (float3)(3.6e-7f), slack);
  const u32 count = scale >> 24;
  const bool nx = ray->rcp.x < 0.0f, ny = ray->rcp.y < 0.0f, nz = ray->rcp.z < 0.0f;
  u32 keys[8] = {0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu,
                 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu};
#if NODE_LOOP == 2
#pragma unroll 1
  for (u32 half_node = 0; half_node * 4u < count; ++half_node) {
#else
#pragma unroll
  for (u32 half_node = 0; half_node < 2u; ++half_node) {
#endif
    const u32 lx = planes[half_node], ly = planes[2u + half_node], lz = planes[4u + half_node],
              ux = planes[6u + half_node], uy = planes[8u + half_node], uz = planes[10u + half_node];
    const u32 near_x = nx ? ux : lx, far_x = nx ? lx : ux, near_y = ny ? uy : ly, far_y = ny ? ly : uy,
              near_z = nz ? uz : lz, far_z = nz ? lz : uz;
#pragma unroll
    for (u32 i = 0; i < 4u; ++i) {
      const u32 at = i * 8u, slot = half_node * 4u + i;
      const int near =
          max(max(as_int(fma((float)(near_x >> at & 0xFFu), step_near.x, near_from.x)),
                  as_int(fma((float)(near_y >> at & 0xFFu), step_near.y, near_from.y))),
              max(as_int(fma((float)(near_z >> at & 0xFFu), step_near.z, near_from.z)), as_int(t_min)));
      const int far =
          min(min(as_int(fma((float)(far_x >> at & 0xFFu), step_far.x, far_from.x)),
                  as_int(fma((float)(far_y >> at & 0xFFu), step_far.y, far_from.y))),
              min(as_int(fma((float)(far_z >> at & 0xFFu), step_far.z, far_from.z)), as_int(t_max)));
      keys[i + 4u] = keys[i];
      keys[i] = near <= far && slot < count ? ((u32)near & ~KEY_SLOT) | slot : 0xFFFFFFFFu;
    }
  }
  // Batcher's network of 19.
#define ORDER(a, b) order_pair(&keys[a], &keys[b])
  ORDER(0, 1), ORDER(2, 3), ORDER(4, 5), ORDER(6, 7), ORDER(0, 2), ORDER(1, 3), ORDER(4, 6), ORDER(5, 7),
      ORDER(1, 2), ORDER(5, 6), ORDER(0, 4), ORDER(1, 5), ORDER(2, 6), ORDER(3, 7), ORDER(2, 4), ORDER(3, 5),
      ORDER(1, 2), ORDER(3, 4), ORDER(5, 6);
#undef ORDER
  u32 list = NO_CHILDREN;
#pragma unroll
  for (u32 i = 8; i > 0u; --i)
    if (keys[i - 1u] != 0xFFFFFFFFu) list = list << 3 | (keys[i - 1u] & KEY_SLOT);
  return list;
}

// The distance in the child's key, computed again.
ALWAYS_INLINE float entry_distance(__global const BvhNode* node, u32 slot, const LeanRay* ray, float t_min) {
  const float3 rcp_near = ray->rcp * NEARER;
  const float3 away = (float3)(node->origin[0], node->origin[1], node->origin[2]) - ray->o;
  const float3 step_near = grid_step(node->scale) * rcp_near;
  float3 near_from = away * rcp_near;
  near_from -= fma(fabs(near_from), (float3)(3.6e-7f), along_face(rcp_near));
  const int near = max(
      max(grid_distance(node, ray->rcp.x < 0.0f ? 24u : 0u, slot, step_near.x, near_from.x),
          grid_distance(node, ray->rcp.y < 0.0f ? 32u : 8u, slot, step_near.y, near_from.y)),
      max(grid_distance(node, ray->rcp.z < 0.0f ? 40u : 16u, slot, step_near.z, near_from.z), as_int(t_min)));
  return as_float((u32)near & ~KEY_SLOT);
}

// A ray in three entries of the stack.
ALWAYS_INLINE void write_ray(const LeanRay* ray, uint2* entries) {
  entries[0] = as_uint2(ray->o.xy);
  entries[1] = as_uint2((float2)(ray->o.z, ray->d.x));
  entries[2] = as_uint2(ray->d.yz);
}
ALWAYS_INLINE void read_ray(const uint2* entries, LeanRay* ray) {
  const float2 a = as_float2(entries[0]), b = as_float2(entries[1]), c = as_float2(entries[2]);
  // One by one: Oclgrind ends at vectors in vectors.
  *ray = lean_ray((float3)(a.x, a.y, b.x), (float3)(b.y, c.x, c.y));
}

// Takes the next word to visit from the stack, and the ray in world space when its mesh is done. False: none.
ALWAYS_INLINE bool next_word(const Scene* scene, float t_min, float t_max, uint2* stack, u32* top,
                             LeanRay* ray, u32* mesh, u32* word) {
  while (*top) {
    const uint2 next = stack[*top - 1u];
    if (next.y == WAITING_RAY) {
      *top -= 4u;
      read_ray(stack + *top, ray);
      *mesh = NO_INSTANCE;
      continue;
    }
    if (next.y == WAITING_WORD) {
      --*top;
      *word = next.x;
      return true;
    }
    __global const BvhNode* node = node_at(scene->nodes, next.x);
    const u32 slot = next.y & KEY_SLOT, rest = next.y >> 3;
    const bool beyond = entry_distance(node, slot, ray, t_min) > t_max;
    if (beyond || rest == NO_CHILDREN)
      --*top;
    else
      stack[*top - 1u].y = rest;
    if (beyond) continue;
    *word = child_word(node, slot);
    return true;
  }
  return false;
}

// Puts the ray on the stack and takes it into the mesh of the instance.
ALWAYS_INLINE void enter_mesh(const Scene* scene, u32 index, float time, uint2* stack, u32* top,
                              LeanRay* ray) {
  write_ray(ray, stack + *top);
  stack[*top + 3u] = (uint2)(0u, WAITING_RAY);
  *top += 4u;
  __global const Instance* instance = scene->instances + index;
  if (!(instance->flags & INSTANCE_IDENTITY))
    *ray = lean_ray(object_point(instance, still_point(scene, index, ray->o, time)),
                    object_vector(instance, still_vector(scene, index, ray->d, time)));
}

#if HAS_LATHE && FEW_REGISTERS
// Tests a solid while the ray and its hit wait on the stack: a lathe's test takes the registers.
ALWAYS_INLINE void trace_solid_alone(const Scene* scene, u32 index, float t_min, float time, uint2* stack,
                                     u32* top, LeanRay* ray, Hit* hit) {
  uint2* to = stack + *top;
  write_ray(ray, to);
  to[3] = as_uint2((float2)(hit->t, hit->u));
  to[4] = (uint2)(as_uint(hit->v), hit->prim);
  to[5] = (uint2)(hit->instance, as_uint(hit->ng_x));
  to[6] = as_uint2((float2)(hit->ng_y, hit->ng_z));
  volatile u32 waiting_top = *top;  // compilers cannot know that they read what they have written
  Hit met = {.t = hit->t, .instance = hit->instance};
  trace_solid(scene, index, ray->o, ray->d, t_min, time, &met);
  *top = waiting_top;
  const uint2 *from = stack + *top, tu = from[3], v_prim = from[4], instance_x = from[5], yz = from[6];
  read_ray(from, ray);
  hit->t = as_float(tu.x), hit->u = as_float(tu.y), hit->v = as_float(v_prim.x);
  hit->prim = v_prim.y, hit->instance = instance_x.x;
  hit->ng_x = as_float(instance_x.y), hit->ng_y = as_float(yz.x), hit->ng_z = as_float(yz.y);
  if (met.instance == index && (hit->instance != index || met.t < hit->t)) *hit = met;
}
#endif

// Traces the bounded instances below `word` of the scene BVH, and their meshes' BVHs, in one loop. A hit's
// prim is for finish_triangle.
static inline void trace_bounded(const Scene* scene, u32 word, float3 o, float3 d, float t_min, float time,
                                 bool any, Hit* found) {
  uint2 stack[BVH_LEVELS];
  LeanRay ray = lean_ray(o, d);
  Hit hit = *found;                 // a copy stays in registers
  u32 top = 0, mesh = NO_INSTANCE;  // the mesh that the ray is in
  for (;;) {
    if (!(word & BVH_LEAF)) {
      __global const BvhNode* node = node_at(scene->nodes, word);
      const u32 list = crossed_children(node, &ray, t_min, hit.t);
      if (list != NO_CHILDREN) {
        if (list >> 3 != NO_CHILDREN) stack[top++] = (uint2)(word, list >> 3);
        word = child_word(node, list & KEY_SLOT);
        continue;
      }
    } else if (HAS_MESH && mesh != NO_INSTANCE) {
      const u32 first = word & BVH_FIRST_MASK,
                last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      const ShearRay shear = make_shear_ray(ray.o, ray.d);
#pragma unroll 1
      for (u32 i = first; i <= last; ++i) closest_in_block(scene->blocks, i, &shear, t_min, mesh, &hit);
      if (any && hit.instance == mesh) break;
    } else {
      const u32 index = word & BVH_FIRST_MASK, more = (word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK;
      if (more) stack[top++] = (uint2)(BVH_LEAF | (more - 1u) << BVH_LEAF_SHIFT | (index + 1u), WAITING_WORD);
      if (HAS_MESH && scene->instances[index].shape == SHAPE_MESH) {
        enter_mesh(scene, index, time, stack, &top, &ray);
        mesh = index;
        word = scene->instances[index].root;
        continue;
      }
#if HAS_LATHE && FEW_REGISTERS
      trace_solid_alone(scene, index, t_min, time, stack, &top, &ray, &hit);
#else
      trace_solid(scene, index, ray.o, ray.d, t_min, time, &hit);
#endif
      if (any && hit.instance != NO_INSTANCE) break;
    }
    if (!next_word(scene, t_min, hit.t, stack, &top, &ray, &mesh, &word)) break;
  }
  *found = hit;
}
#endif

// Traces all bounded instances. A single one is a leaf without a tree, so that instances are traced in one
// place, of which some compilers make copies.
static inline void trace_instances(const Scene* scene, float3 o, float3 d, float t_min, float time, bool any,
                                   Hit* hit) {
#if !WIDE_VECTORS  // which has no tree here
  if (scene->info->bounded_count == 0u) return;
  trace_bounded(scene, scene->info->tlas_root, o, d, t_min, time, any, hit);
#endif
}

#endif
