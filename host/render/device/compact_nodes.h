// The BVH for devices that run a lane a ray: each node on a grid of its own, see CompactNode.
#pragma once
#include <span>
#include <vector>

#include "shared/bvh.h"

namespace sundog {

/// A node of the same index for each. A compact box contains the box that it stands for. The children's
/// leaves must lie near each other in their table, as build_wide_bvh() leaves them; throws std::logic_error.
std::vector<CompactNode> compact_nodes(std::span<const Bvh8Node> nodes);

}  // namespace sundog
