// Converts a BVH for devices with one ray per lane: each node gets its own grid, see CompactNode.
#pragma once
#include <span>
#include <vector>

#include "shared/bvh.h"

namespace sundog {

/// Converts each node, keeping indices. A compact box contains the original. The children's leaves must be
/// close together in their table, as from build_wide_bvh(); throws std::logic_error otherwise.
std::vector<CompactNode> compact_nodes(std::span<const Bvh8Node> nodes);

}  // namespace sundog
