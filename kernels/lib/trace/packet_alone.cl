// Traces rays of a packet singly.
#pragma once
#include "lib/core/config.h"
#if PACKETS
#include "lib/core/tables.h"
#include "lib/trace/packet_nodes.cl"
#include "lib/trace/walk.cl"

// Traces the rays of `active` singly from `word` of the scene BVH or of `instance`'s mesh BVH on. Returns
// whether any hits something nearer.
NEVER_INLINE bool walk_lanes(const Scene* scene, const PacketRays* rays, PacketHits* hits, u32 active,
                             u32 word, u32 instance, bool any) {
  const REAL3 o = real3(rays->o[0], rays->o[1], rays->o[2]), d = real3(rays->d[0], rays->d[1], rays->d[2]);
  const REAL before = hits->found->t;
  const TraceRays traced = {&o, &d, &hits->t_min, hits->found, 0, 0};
  walk_rays(scene, &traced, active, word, instance, any);
  const MASK nearer = MASK_OF(hits->found->t < before);
  if (any) end_lanes(hits, lanes_of(active));
  return any_lane(nearer);
}

#endif
