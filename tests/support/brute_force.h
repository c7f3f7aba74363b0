// Searches of a compiled scene that do not trust its BVH.
#pragma once
#include <optional>
#include <vector>

#include "bench/rays/exact_tracer.h"

namespace sundog {

/// trace_host() without the BVH: tries every instance and every block of its mesh.
inline std::optional<HostHit> trace_brute_force(const CompiledScene& scene, const HostRay& ray) {
  std::optional<HostHit> nearest;
  for (u32 i = 0; i < scene.info.instance_count; ++i)
    if (const auto hits = crossings(scene, i, ray); !hits.empty() && (!nearest || hits[0].t < nearest->t))
      nearest = hits[0];
  return nearest;
}

/// The blocks or instances below a node or leaf word.
inline std::vector<u32> leaf_items(const CompiledScene& scene, u32 word) {
  std::vector<u32> items;
  if (word & BVH_LEAF) {
    const u32 last = word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK;
    for (u32 i = 0; i <= last; ++i) items.push_back((word & BVH_FIRST_MASK) + i);
    return items;
  }
  const Bvh8Node& node = scene.nodes.at(word);
  for (u32 slot = 0; slot < BVH_WIDTH; ++slot)
    if (node.valid >> slot & 1u)
      for (const u32 item : leaf_items(scene, node.child[slot])) items.push_back(item);
  return items;
}

}  // namespace sundog
