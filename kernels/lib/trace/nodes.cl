// Tests one ray against the eight children of a BVH node. Slabs are widened to be conservative (Ize 2013), so
// results do not depend on the order of visits.
#pragma once
#include "lib/core/config.h"
#include "lib/core/lanes.h"
#include "lib/core/masks.cl"
#include "shared/bvh.h"

#if WIDE_VECTORS
typedef Bvh8Node BvhNode;
static inline u32 child_word(__global const BvhNode* node, u32 slot) { return node->child[slot]; }
#else
typedef CompactNode BvhNode;
static inline u32 child_word(__global const BvhNode* node, u32 slot) {
  const u32 child = node->child[slot >> 1] >> (slot & 1u) * 16u & 0xFFFFu;
  if (!(child & COMPACT_LEAF)) return node->first_inner + child;
  const u32 count = child >> COMPACT_COUNT_SHIFT & BVH_LEAF_COUNT_MASK;
  return BVH_LEAF | count << BVH_LEAF_SHIFT | (node->first_leaf + (child & COMPACT_LEAF_DISTANCE));
}
#endif

static inline __global const BvhNode* node_at(__global const u32* nodes, u32 index) {
  return (__global const BvhNode*)nodes + index;
}

// A ray prepared for slab tests: it crosses a plane at b at fma(b, rcp, shift). near_* and far_* are float
// offsets into Bvh8Node and byte offsets into CompactNode's boxes, by the direction's signs.
typedef struct SlabRay {
#if !WIDE_VECTORS
  float3 o;
#endif
  float3 rcp_near, rcp_far, shift_near, shift_far;
  u32 near_x, near_y, near_z, far_x, far_y, far_z;
} SlabRay;

// Replaces components too small to divide by: such a ray crosses no slab within a float's range.
#define LEAST_COMPONENT 1e-18f
static inline float3 safe_reciprocal(float3 d) {
  return 1.0f / select(d, copysign((float3)(LEAST_COMPONENT), d), fabs(d) < LEAST_COMPONENT);
}

// Distances that matter only to axis-parallel rays, which may run in a face, or in the plane through 0, where
// relative widening is nothing.
#define along_face(rcp) ((rcp) * (rcp) * 1e-25f)

// Factors on a reciprocal that make a slab's entry earlier and exit later, and shifts of its near and far
// planes for `at` (origin times reciprocal); V is their type.
#define NEARER 0.9999997f
#define FARTHER 1.0000003f
#define shift_to_near(V, at, slack) (-((at) + fma(fabs(at), (V)(2.4e-7f), slack)))
#define shift_to_far(V, at, slack) (-((at) - fma(fabs(at), (V)(2.4e-7f), slack)))

static inline SlabRay make_slab_ray(float3 o, float3 d) {
  SlabRay ray;
#if !WIDE_VECTORS
  ray.o = o;
#endif
  const float3 rcp = safe_reciprocal(d), slack = along_face(rcp);
  ray.rcp_near = rcp * NEARER;
  ray.rcp_far = rcp * FARTHER;
  const float3 near = o * ray.rcp_near, far = o * ray.rcp_far;
  ray.shift_near = shift_to_near(float3, near, slack);
  ray.shift_far = shift_to_far(float3, far, slack);
  // By the sign of the reciprocal, because -0 has a negative one.
  ray.near_x = rcp.x < 0.0f ? 24u : 0u;
  ray.near_y = rcp.y < 0.0f ? 32u : 8u;
  ray.near_z = rcp.z < 0.0f ? 40u : 16u;
  ray.far_x = 24u - ray.near_x;
  ray.far_y = 40u - ray.near_y;
  ray.far_z = 56u - ray.near_z;
  return ray;
}

// A child's key: the bits of its entry distance (non-negative floats order like integers) with the slot in
// the lowest three.
#define KEY_SLOT 7u

#if WIDE_VECTORS
// One axis of make_slab_ray with one ray per lane. Returns the reciprocal.
static inline REAL aim_slabs(REAL o, REAL d, REAL* rcp_near, REAL* rcp_far, REAL* shift_near,
                             REAL* shift_far) {
  const REAL least = AS_REAL((AS_MASK(d) & (int)0x80000000) | as_int(LEAST_COMPONENT));
  const REAL rcp = 1.0f / select(d, least, MASK_OF(fabs(d) < LEAST_COMPONENT)), slack = along_face(rcp);
  *rcp_near = rcp * NEARER;
  *rcp_far = rcp * FARTHER;
  const REAL near = o * *rcp_near, far = o * *rcp_far;
  *shift_near = shift_to_near(REAL, near, slack);
  *shift_far = shift_to_far(REAL, far, slack);
  return rcp;
}

// Entry and exit distances of the eight children's boxes, clipped to [t_min, t_max], as float bits: a child
// is crossed if near <= far.
ALWAYS_INLINE void slab_distances(__global const BvhNode* node, const SlabRay* ray, float t_min, float t_max,
                                  int8* near, int8* far) {
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
  *near = max(max(near_x, near_y), max(near_z, (int8)(as_int(t_min))));
  *far = min(min(far_x, far_y), min(far_z, (int8)(as_int(t_max))));
}

// Sorts lanes in descending order: Batcher's bitonic network (1968), without branches.
ALWAYS_INLINE uint8 sort_descending(uint8 v) {
  uint8 w = v.s10325476;
  v = select(min(v, w), max(v, w), (int8)(-1, 0, 0, -1, -1, 0, 0, -1));
  w = v.s23016745;
  v = select(min(v, w), max(v, w), (int8)(-1, -1, 0, 0, 0, 0, -1, -1));
  w = v.s10325476;
  v = select(min(v, w), max(v, w), (int8)(-1, 0, -1, 0, 0, -1, 0, -1));
  w = v.s45670123;
  v = select(min(v, w), max(v, w), (int8)(-1, -1, -1, -1, 0, 0, 0, 0));
  w = v.s23016745;
  v = select(min(v, w), max(v, w), (int8)(-1, -1, 0, 0, -1, -1, 0, 0));
  w = v.s10325476;
  return select(min(v, w), max(v, w), (int8)(-1, 0, -1, 0, -1, 0, -1, 0));
}

ALWAYS_INLINE uint4 sort_descending4(uint4 v) {
  uint4 w = v.s1032;
  v = select(min(v, w), max(v, w), (int4)(-1, 0, 0, -1));
  w = v.s2301;
  v = select(min(v, w), max(v, w), (int4)(-1, -1, 0, 0));
  w = v.s1032;
  return select(min(v, w), max(v, w), (int4)(-1, 0, -1, 0));
}

// Lane i of the result is v's lane order[i] & 7.
ALWAYS_INLINE uint8 permute(uint8 v, uint8 order) {
#if defined(__AVX2__) && !defined(SUNDOG_PORTABLE)
  return as_uint8(__builtin_ia32_permvarsi256(as_int8(v), as_int8(order)));
#else
  return shuffle(v, order);
#endif
}

// Packs the lanes of v that are set in `lanes` to the front, followed by zeros. Without an instruction for
// it, packing does not pay.
#if defined(__AVX512VL__) && !defined(SUNDOG_PORTABLE)
#define HAS_PACKING 1
ALWAYS_INLINE uint8 packed(uint8 v, u32 lanes) {
  return as_uint8(__builtin_ia32_compresssi256_mask(as_int8(v), (int8)(0), (uchar)lanes));
}
#else
#define HAS_PACKING 0
#endif

// Pushes the children crossed in [t_min, t_max] with their entry distances, farthest first, and returns their
// number. Always overwrites eight stack places to avoid a branch, since the number of crossed children is
// unpredictable; but it is usually at most four, and packed they take half the sorting network.
ALWAYS_INLINE u32 push_crossed(__global const BvhNode* node, const SlabRay* ray, float t_min, float t_max,
                               u32* stack, float* stack_t) {
  int8 near, far;
  slab_distances(node, ray, t_min, t_max, &near, &far);
  const uint8 words = vload8(0, node->child);
  const int8 crossed = (near <= far) & (words != BVH_EMPTY);
  const u32 lanes = lane_mask(crossed), count = popcount(lanes);
  const uint8 keys = (as_uint8(near) & ~KEY_SLOT) | (uint8)(0, 1, 2, 3, 4, 5, 6, 7);
#if HAS_PACKING
  if (count <= 4u) {
    const uint4 order = sort_descending4(packed(keys, lanes).lo);
    vstore4(permute(words, (uint8)(order, order)).lo, 0, stack);
    vstore4(as_float4(order & ~KEY_SLOT), 0, stack_t);
    return count;
  }
#endif
  const uint8 order = sort_descending(keys & as_uint8(crossed));
  vstore8(permute(words, order), 0, stack);
  vstore8(as_float8(order & ~KEY_SLOT), 0, stack_t);
  return count;
}

// push_crossed() for any-hit rays: in slot order if packing is faster than sorting, because nearest-first
// order hardly saves them visits. stack_t may remain unset.
ALWAYS_INLINE u32 push_in_any_order(__global const BvhNode* node, const SlabRay* ray, float t_min,
                                    float t_max, u32* stack, float* stack_t) {
#if HAS_PACKING
  int8 near, far;
  slab_distances(node, ray, t_min, t_max, &near, &far);
  const uint8 words = vload8(0, node->child);
  const u32 crossed = lane_mask((near <= far) & (words != BVH_EMPTY));
  vstore8(packed(words, crossed), 0, stack);
  return popcount(crossed);
#else
  return push_crossed(node, ray, t_min, t_max, stack, stack_t);
#endif
}

// The children crossed in [t_min, t_max], a bit each.
ALWAYS_INLINE u32 cross_children(__global const BvhNode* node, const SlabRay* ray, float t_min, float t_max) {
  int8 near, far;
  slab_distances(node, ray, t_min, t_max, &near, &far);
  return lane_mask(near <= far) & node->valid;
}
#else
static inline float3 grid_step(u32 scale) {
  return (float3)(as_float((scale & 0xFFu) << 23), as_float((scale >> 8 & 0xFFu) << 23),
                  as_float((scale >> 16 & 0xFFu) << 23));
}

// Distance to a plane of slot `slot`; the planes' bytes begin at `plane`.
static inline int grid_distance(__global const BvhNode* node, u32 plane, u32 slot, float step, float from) {
  const u32 at = plane + slot;
  return as_int(fma((float)(node->quantized[at >> 2] >> (at & 3u) * 8u & 0xFFu), step, from));
}

ALWAYS_INLINE u32 cross_children(__global const BvhNode* node, const SlabRay* ray, float t_min, float t_max) {
  const float3 away = (float3)(node->origin[0], node->origin[1], node->origin[2]) - ray->o;
  const float3 step = grid_step(node->scale), step_near = step * ray->rcp_near,
               step_far = step * ray->rcp_far;
  float3 near_from = away * ray->rcp_near, far_from = away * ray->rcp_far;
  const float3 slack = along_face(ray->rcp_near);
  near_from -= fma(fabs(near_from), (float3)(3.6e-7f), slack);
  far_from += fma(fabs(far_from), (float3)(3.6e-7f), slack);
  const u32 count = node->scale >> 24;
  u32 crossed = 0;
#pragma unroll 1
  for (u32 i = 0; i < count; ++i) {
    const int near = max(max(grid_distance(node, ray->near_x, i, step_near.x, near_from.x),
                             grid_distance(node, ray->near_y, i, step_near.y, near_from.y)),
                         max(grid_distance(node, ray->near_z, i, step_near.z, near_from.z), as_int(t_min)));
    const int far = min(min(grid_distance(node, ray->far_x, i, step_far.x, far_from.x),
                            grid_distance(node, ray->far_y, i, step_far.y, far_from.y)),
                        min(grid_distance(node, ray->far_z, i, step_far.z, far_from.z), as_int(t_max)));
    if (near <= far) crossed |= 1u << i;
  }
  return crossed;
}
#endif

static inline void order_pair(u32* a, u32* b) {
  const u32 low = min(*a, *b), high = max(*a, *b);
  *a = low;
  *b = high;
}
