// Traces sixteen coherent rays through the two-level BVH as a packet (packet_nodes.cl, packet_mesh.cl). When
// few rays remain, they continue singly.
#pragma once
#include "lib/core/config.h"
#if PACKETS
#include "lib/core/tables.h"
#include "lib/trace/packet_alone.cl"
#include "lib/trace/packet_mesh.cl"
#include "lib/trace/packet_nodes.cl"

// This few rays in the scene or in an instance continue singly.
#ifndef PACKET_LEAST
#define PACKET_LEAST 2
#endif

static inline void packet_in_solid(const Scene* scene, const PacketRays* rays, PacketHits* hits, u32 active,
                                   u32 index, bool any) {
  const REAL3 o = real3(rays->o[0], rays->o[1], rays->o[2]), d = real3(rays->d[0], rays->d[1], rays->d[2]);
  hit_solids(scene->instances, (uint2)(index, index + 1u), &o, &d, &hits->t_min, lanes_of(active),
             TRACE_NEAREST, hits->found);
  if (any) end_lanes(hits, lanes_of(active));
}

// Tests the rays of `active` against an instance; world space.
NEVER_INLINE void packet_in_instance(const Scene* scene, const PacketRays* rays, PacketHits* hits, u32 active,
                                     u32 index, bool any) {
  __global const Instance* instance = scene->instances + index;
  if (HAS_MESH && instance->shape == SHAPE_MESH) {
    if (popcount(active) <= PACKET_LEAST) {
      walk_lanes(scene, rays, hits, active, BVH_LEAF | index, NO_INSTANCE, any);
      return;
    }
    if (instance->flags & INSTANCE_IDENTITY) {
      packet_in_mesh(scene, rays, hits, instance->root, index, any);
      return;
    }
    PacketRays object;
    packet_in_object(scene, index, rays, hits->found, active, &object);
    if (aim_packet(&object)) {
      const int16 lanes = lanes_of(active);
      const float16 t = hits->found->t;  // of the other rays, restored afterwards
      hits->found->t = select((float16)(-1.0f), t, lanes);
      renew_bounds(hits);
      packet_in_mesh(scene, &object, hits, instance->root, index, any);
      hits->found->t = select(t, hits->found->t, lanes);
    } else
      walk_lanes(scene, rays, hits, active, BVH_LEAF | index, NO_INSTANCE, any);
    return;
  }
  packet_in_solid(scene, rays, hits, active, index, any);
}

NEVER_INLINE void packet_in_leaf(const Scene* scene, const PacketRays* rays, PacketHits* hits, u32 active,
                                 u32 word, bool any) {
  const u32 first = word & BVH_FIRST_MASK, last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
  for (u32 i = first; i <= last; ++i) {
    if (any) active &= ~lane_bits(as_int16(hits->found->t));  // these have a hit
    if (active) packet_in_instance(scene, rays, hits, active, i, any);
  }
  renew_bounds(hits);
}

// Traces the bounded instances; `rays` in world space and prepared.
NEVER_INLINE void packet_in_scene(const Scene* scene, const PacketRays* rays, PacketHits* hits, bool any) {
  const u32 live = ALL_RAYS & ~lane_bits(as_int16(hits->found->t)), root = scene->info->tlas_root;
  if (root & BVH_LEAF) {
    packet_in_leaf(scene, rays, hits, live, root, any);
  } else {
    PacketWalk walk;
    walk.top = 0;
    walk.first = root;
    u32 word, active;
    while (next_place(scene->nodes, rays, hits, &walk, any, &word, &active)) {
      if (word & BVH_LEAF)
        packet_in_leaf(scene, rays, hits, active, word, any);
      else
        walk_lanes(scene, rays, hits, active, word, NO_INSTANCE, any);
      renew_bounds(hits);
    }
  }
}

#endif
