// Traverses a BVH's nodes with packets: tests a node's eight children at once against the interval of all
// rays, and each ray against children that not all rays certainly cross.
#pragma once
#include "lib/core/config.h"
#if PACKETS
#include "lib/trace/packet_rays.cl"

// This few rays in a node continue singly.
#ifndef NODE_LEAST
#define NODE_LEAST 1
#endif

// A child's box: node * 8 + slot; ALL_CROSS: every ray crosses it.
#define ALL_CROSS 0x80000000u
#define NO_BOX 0xFFFFFFFFu
#define NO_NODE 0xFFFFFFFFu

// Waiting boxes, each below the bits of its entry distance; nearest last.
typedef struct PacketWalk {
  ulong waiting[BVH_STACK + 1];
  u32 top;
  u32 first;  // the start node
} PacketWalk;

ALWAYS_INLINE int8 crossing_at(float8 planes, const Crossing* crossing, u32 axis) {
  return as_int8(fma(planes, (float8)(crossing->rcp[axis]), (float8)(crossing->shift[axis])));
}

// Returns the nearest child that the interval crosses, or NO_BOX, and pushes the others. With `any` in slot
// order, because sorting costs more than it saves.
ALWAYS_INLINE u32 open_node(__global const u32* restrict nodes, u32 index, const PacketRays* rays,
                            const PacketHits* hits, PacketWalk* walk, bool any) {
  __global const BvhNode* node = node_at(nodes, index);
  __global const float* bounds = node->lower_x;
  int8 near = (int8)(as_int(hits->t_least)), far = (int8)(as_int(hits->t_most));
  int8 last_in = near, first_out = far;
#pragma unroll
  for (u32 axis = 0; axis < 3u; ++axis) {
    const float8 b = vload8(0, bounds + rays->near[axis]), c = vload8(0, bounds + rays->far[axis]);
    near = max(near, crossing_at(b, &rays->first_in, axis));
    far = min(far, crossing_at(c, &rays->last_out, axis));
    last_in = max(last_in, crossing_at(b, &rays->last_in, axis));
    first_out = min(first_out, crossing_at(c, &rays->first_out, axis));
  }
  const u32 by_all = lane_mask(last_in <= first_out);
  u32 crossed = lane_mask(near <= far) & node->valid;
  if (!crossed) return NO_BOX;
  u32 slot = lowest_bit(crossed);
  crossed &= crossed - 1u;
  u32 nearest = (index * 8u + slot) | (by_all >> slot) << 31;
  if (!crossed) return nearest;
  float entry[8];
  vstore8(as_float8(near), 0, entry);
  ulong least = (ulong)as_uint(entry[slot]) << 32 | nearest;
  const u32 base = walk->top;
  while (crossed) {
    slot = lowest_bit(crossed);
    crossed &= crossed - 1u;
    ulong box = (ulong)as_uint(entry[slot]) << 32 | (index * 8u + slot) | (by_all >> slot) << 31;
    u32 to = walk->top++;
    const ulong nearer = any ? box : min(box, least);
    box = any ? least : max(box, least);
    least = nearer;
    if (!any) {
      while (to > base && walk->waiting[to - 1u] < box) {
        walk->waiting[to] = walk->waiting[to - 1u];
        --to;
      }
    }
    walk->waiting[to] = box;
  }
  return (u32)least;
}

// Each ray's entry or exit distance of a slab along one axis.
ALWAYS_INLINE int16 slab_distance(float bound, float16 rcp, float16 shift) {
  return as_int16(fma((float16)(bound), rcp, shift));
}

// The rays that cross the box of one child.
ALWAYS_INLINE u32 rays_in_child(__global const Bvh8Node* node, u32 slot, const PacketRays* rays,
                                const PacketHits* hits) {
  __global const float* bounds = node->lower_x + slot;
  int16 near = as_int16(hits->t_min), far = as_int16(hits->found->t);
#pragma unroll
  for (u32 axis = 0; axis < 3u; ++axis) {
    near = max(near, slab_distance(bounds[rays->near[axis]], rays->rcp_near[axis], rays->shift_near[axis]));
    far = min(far, slab_distance(bounds[rays->far[axis]], rays->rcp_far[axis], rays->shift_far[axis]));
  }
  return lane_bits(near <= far);
}

// Finds the next leaf, or node that few rays cross. Writes its word and the rays that cross it; returns false
// at the end.
NEVER_INLINE bool next_place(__global const u32* restrict nodes, const PacketRays* rays,
                             const PacketHits* hits, PacketWalk* walk, bool any, u32* word, u32* active) {
  u32 index = walk->first;
  walk->first = NO_NODE;
  while (true) {
    u32 box;
    if (index != NO_NODE) {
      box = open_node(nodes, index, rays, hits, walk, any);
      index = NO_NODE;
      if (box == NO_BOX) continue;
    } else {
      if (!walk->top) return false;
      const ulong next = walk->waiting[--walk->top];
      if (as_float((u32)(next >> 32)) > hits->t_most) continue;
      box = (u32)next;
    }
    __global const BvhNode* node = node_at(nodes, (box & ~ALL_CROSS) >> 3);
    const u32 crossing = box & ALL_CROSS ? hits->live : rays_in_child(node, box & 7u, rays, hits);
    if (!crossing) continue;
    *word = node->child[box & 7u];
    *active = crossing;
    if ((*word & BVH_LEAF) || popcount(crossing) <= NODE_LEAST) return true;
    index = *word;
  }
}

#endif
