// The CPU-class tracer: one ray through the two-level BVH, eight children or eight triangles an instruction.
// In: a ray and the tables. Out: the nearest hit, or whether there is any. This file is the narrow interface
// that shading sees. Slabs are widened to be conservative (Ize 2013), so the nearest hit does not depend on
// the order of visits; children are visited by a key that packs the entry distance and the slot.
#ifndef SUNDOG_LIB_TRAVERSE_CL
#define SUNDOG_LIB_TRAVERSE_CL
#include "lib/config.h"
#include "lib/solids.cl"
#include "lib/tables.h"
#include "lib/transform.cl"
#include "lib/triangles.cl"

// A ray prepared for slab tests. near_* and far_* are float offsets into Bvh8Node, by the direction's signs.
typedef struct SlabRay {
  float3 rcp_near, rcp_far, shift_near, shift_far;
  u32 near_x, near_y, near_z, far_x, far_y, far_z;
} SlabRay;

// A component too small to divide by stands for a slope that never crosses a slab within a float's range.
static inline float safe_reciprocal(float d) { return 1.0f / (fabs(d) < 1e-18f ? copysign(1e-18f, d) : d); }

static inline SlabRay make_slab_ray(float3 o, float3 d) {
  SlabRay ray;
  const float3 rcp = (float3)(safe_reciprocal(d.x), safe_reciprocal(d.y), safe_reciprocal(d.z));
  ray.rcp_near = rcp * 0.9999997f;
  ray.rcp_far = rcp * 1.0000003f;
  const float3 near = o * ray.rcp_near, far = o * ray.rcp_far;
  ray.shift_near = -(near + fabs(near) * 2.4e-7f);
  ray.shift_far = -(far - fabs(far) * 2.4e-7f);
  ray.near_x = d.x < 0.0f ? 24u : 0u;
  ray.near_y = d.y < 0.0f ? 32u : 8u;
  ray.near_z = d.z < 0.0f ? 40u : 16u;
  ray.far_x = 24u - ray.near_x;
  ray.far_y = 40u - ray.near_y;
  ray.far_z = 56u - ray.near_z;
  return ray;
}

// A child's key is the bits of its entry distance (non-negative floats order like integers) with the slot in
// the lowest three.
#define KEY_SLOT 7

#if WIDE_VECTORS
// Writes the keys of the eight children; returns which are crossed.
static inline u32 cross_children(__global const Bvh8Node* node, const SlabRay* ray, float t_min, float t_max,
                                 u32* keys) {
  __global const float* bounds = node->lower_x;
  const int8 near_x =
      as_int8(fma(vload8(0, bounds + ray->near_x), (float8)(ray->rcp_near.x), (float8)(ray->shift_near.x)));
  const int8 near_y =
      as_int8(fma(vload8(0, bounds + ray->near_y), (float8)(ray->rcp_near.y), (float8)(ray->shift_near.y)));
  const int8 near_z =
      as_int8(fma(vload8(0, bounds + ray->near_z), (float8)(ray->rcp_near.z), (float8)(ray->shift_near.z)));
  const int8 far_x =
      as_int8(fma(vload8(0, bounds + ray->far_x), (float8)(ray->rcp_far.x), (float8)(ray->shift_far.x)));
  const int8 far_y =
      as_int8(fma(vload8(0, bounds + ray->far_y), (float8)(ray->rcp_far.y), (float8)(ray->shift_far.y)));
  const int8 far_z =
      as_int8(fma(vload8(0, bounds + ray->far_z), (float8)(ray->rcp_far.z), (float8)(ray->shift_far.z)));
  const int8 near = max(max(near_x, near_y), max(near_z, (int8)(as_int(t_min))));
  const int8 far = min(min(far_x, far_y), min(far_z, (int8)(as_int(t_max))));
  const u32 crossed = lane_mask(near <= far) & node->valid;
  if (crossed) vstore8((as_uint8(near) & ~(u32)KEY_SLOT) | (uint8)(0, 1, 2, 3, 4, 5, 6, 7), 0, keys);
  return crossed;
}
#else
static inline u32 cross_children(__global const Bvh8Node* node, const SlabRay* ray, float t_min, float t_max,
                                 u32* keys) {
  __global const float* bounds = node->lower_x;
  u32 crossed = 0;
#pragma unroll 1
  for (u32 i = 0; i < 8u; ++i) {
    const int near =
        max(max(as_int(fma(bounds[ray->near_x + i], ray->rcp_near.x, ray->shift_near.x)),
                as_int(fma(bounds[ray->near_y + i], ray->rcp_near.y, ray->shift_near.y))),
            max(as_int(fma(bounds[ray->near_z + i], ray->rcp_near.z, ray->shift_near.z)), as_int(t_min)));
    const int far =
        min(min(as_int(fma(bounds[ray->far_x + i], ray->rcp_far.x, ray->shift_far.x)),
                as_int(fma(bounds[ray->far_y + i], ray->rcp_far.y, ray->shift_far.y))),
            min(as_int(fma(bounds[ray->far_z + i], ray->rcp_far.z, ray->shift_far.z)), as_int(t_max)));
    if (near <= far) crossed |= 1u << i;
    keys[i] = ((u32)near & ~(u32)KEY_SLOT) | i;
  }
  return crossed & node->valid;
}
#endif

static inline void order_pair(u32* a, u32* b) {
  const u32 low = min(*a, *b), high = max(*a, *b);
  *a = low;
  *b = high;
}

// Pushes the crossed children, farthest first, and returns the nearest one's word.
static inline u32 push_children(__global const Bvh8Node* node, u32 crossed, const u32* keys, u32* stack,
                                float* stack_t, u32* top) {
  u32 a = keys[lowest_bit(crossed)];
  crossed &= crossed - 1u;
  if (crossed) {
    u32 b = keys[lowest_bit(crossed)];
    crossed &= crossed - 1u;
    order_pair(&a, &b);
    if (crossed) {
      u32 c = keys[lowest_bit(crossed)];
      crossed &= crossed - 1u;
      order_pair(&b, &c);
      order_pair(&a, &b);
      // Four and more are rare: insertion into what already waits.
      const u32 base = *top;
      stack[base] = node->child[c & KEY_SLOT];
      stack_t[base] = as_float(c & ~(u32)KEY_SLOT);
      *top = base + 1u;
      while (crossed) {
        u32 next = keys[lowest_bit(crossed)];
        crossed &= crossed - 1u;
        order_pair(&b, &next);
        order_pair(&a, &b);
        u32 at = *top;
        const float t = as_float(next & ~(u32)KEY_SLOT);
        while (at > base && stack_t[at - 1u] < t) {
          stack[at] = stack[at - 1u];
          stack_t[at] = stack_t[at - 1u];
          --at;
        }
        stack[at] = node->child[next & KEY_SLOT];
        stack_t[at] = t;
        *top += 1u;
      }
    }
    stack[*top] = node->child[b & KEY_SLOT];
    stack_t[*top] = as_float(b & ~(u32)KEY_SLOT);
    *top += 1u;
  }
  return node->child[a & KEY_SLOT];
}

#if HAS_MESH
// Nearest hit in one mesh BVH. o, d in object space; the stack is used from *stack on.
static inline void closest_in_mesh(TRACE_PARAMETERS, u32 root, float3 o, float3 d, float t_min, u32 instance,
                                   u32* stack, float* stack_t, Hit* hit) {
  const SlabRay slabs = make_slab_ray(o, d);
  u32 top = 0, word = root;
  for (;;) {
    if (word & BVH_LEAF) {
      const u32 first = word & BVH_FIRST_MASK,
                last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      for (u32 i = first; i <= last; ++i) closest_in_block(blocks + i, o, d, t_min, instance, hit);
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
#endif

// Nearest hit with one instance in (t_min, hit->t]; world-space ray.
static inline void closest_in_instance(TRACE_PARAMETERS, u32 index, float3 o, float3 d, float t_min,
                                       u32* stack, float* stack_t, Hit* hit) {
  __global const Instance* instance = instances + index;
  const float3 oo = object_point(instance, o), dd = object_vector(instance, d);
#if HAS_MESH
  if (instance->shape == SHAPE_MESH) {
    closest_in_mesh(TRACE_ARGUMENTS, instance->root, oo, dd, t_min, index, stack, stack_t, hit);
    return;
  }
#endif
  SolidHit solid;
  if (!closest_in_solid(instance->shape, instance->parameters, oo, dd, t_min, hit->t, &solid)) return;
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

static inline bool finite3(float3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

// The nearest hit in (t_min, t_max]; without one, hit.instance is NO_INSTANCE. With `any` set the search ends
// at the first hit found. A ray with a component that is not finite, or with no direction, hits nothing.
static inline Hit trace_ray(TRACE_PARAMETERS, float3 o, float3 d, float t_min, float t_max, bool any) {
  Hit hit = {t_max, 0.0f, 0.0f, NO_PRIM, NO_INSTANCE, 0.0f, 0.0f, 0.0f};
  if (!(finite3(o) && finite3(d) && t_max > t_min && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f))) return hit;
#if HAS_PLANE
  u32 unbounded = info->bounded_count;
#endif
  u32 stack[BVH_STACK];
  float stack_t[BVH_STACK];
  u32 top = 0, next = 0, end = 0, word = info->tlas_root;
  bool walking = info->bounded_count > 0u;
  const SlabRay slabs = make_slab_ray(o, d);
  for (;;) {
    if (next < end) {  // the instances of a leaf
      closest_in_instance(TRACE_ARGUMENTS, next, o, d, t_min, stack + top, stack_t + top, &hit);
      ++next;
      if (any && hit.instance != NO_INSTANCE) return hit;
      continue;
    }
    if (walking) {
      if (word & BVH_LEAF) {
        next = word & BVH_FIRST_MASK;
        end = next + 1u + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      } else {
        u32 keys[8];
        const u32 crossed = cross_children(nodes + word, &slabs, t_min, hit.t, keys);
        if (crossed) {
          word = push_children(nodes + word, crossed, keys, stack, stack_t, &top);
          continue;
        }
      }
      do {
        if (!top) {
          walking = false;
          break;
        }
        --top;
      } while (stack_t[top] > hit.t);
      if (walking) word = stack[top];
      continue;
    }
#if HAS_PLANE
    if (unbounded < info->instance_count) {
      next = unbounded;
      end = info->instance_count;
      unbounded = end;
      continue;
    }
#endif
    return hit;
  }
}

#endif
