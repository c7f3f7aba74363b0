// Rounds boxes outwards to a grid with a power-of-two step per axis; stores children relative to the first of
// their kind.
#include "render/device/compact_nodes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"

namespace sundog {
namespace {

constexpr int bias = 127, steps = 255;

/// The smallest power of two, as a biased exponent, such that 255 steps of it cover `extent`.
u32 step_exponent(double extent) {
  int exponent = 0;
  if (extent > 0) std::frexp(extent / steps, &exponent);  // extent / steps < 2^exponent
  return static_cast<u32>(std::clamp(exponent + bias, 1, 254));
}

/// Quantises one axis of all boxes to the node's grid.
void quantize_axis(const float* lower, const float* upper, u32 count, u32 axis, CompactNode& node) {
  const float origin = *std::min_element(lower, lower + count), end = *std::max_element(upper, upper + count);
  const u32 exponent = step_exponent(double(end) - double(origin));
  const double step = std::ldexp(1.0, static_cast<int>(exponent) - bias);
  node.origin[axis] = origin;
  node.scale |= exponent << axis * 8;
  const auto put = [&](u32 plane, u32 slot, double value) {
    const auto byte = static_cast<u32>(std::clamp(value, 0.0, double(steps)));
    node.quantized[(plane + slot) / 4] |= byte << (plane + slot) % 4 * 8;
  };
  for (u32 slot = 0; slot < count; ++slot) {
    put(axis * 8, slot, std::floor((double(lower[slot]) - double(origin)) / step));
    put(24 + axis * 8, slot, std::ceil((double(upper[slot]) - double(origin)) / step));
  }
}

/// Stores the children's positions, relative to the smallest index of their kind.
void set_children(const Bvh8Node& wide, u32 count, CompactNode& node) {
  node.first_inner = node.first_leaf = NO_PRIM;
  for (u32 slot = 0; slot < count; ++slot) {
    const u32 word = wide.child[slot];
    u32& first = word & BVH_LEAF ? node.first_leaf : node.first_inner;
    first = std::min(first, word & BVH_LEAF ? word & BVH_FIRST_MASK : word);
  }
  for (u32 slot = 0; slot < count; ++slot) {
    const u32 word = wide.child[slot];
    const bool leaf = word & BVH_LEAF;
    const u32 distance = leaf ? (word & BVH_FIRST_MASK) - node.first_leaf : word - node.first_inner;
    if (distance > (leaf ? COMPACT_LEAF_DISTANCE : COMPACT_INNER_DISTANCE))
      throw std::logic_error("children of a BVH node lie too far from each other");
    const u32 blocks = word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK;
    const u32 bits = leaf ? COMPACT_LEAF | blocks << COMPACT_COUNT_SHIFT | distance : distance;
    node.child[slot / 2] |= bits << slot % 2 * 16;
  }
}

CompactNode compact(const Bvh8Node& wide) {
  CompactNode node{};
  const auto count = static_cast<u32>(std::popcount(wide.valid));
  node.scale = count << 24;
  if (count == 0) return node;
  quantize_axis(wide.lower_x, wide.upper_x, count, 0, node);
  quantize_axis(wide.lower_y, wide.upper_y, count, 1, node);
  quantize_axis(wide.lower_z, wide.upper_z, count, 2, node);
  set_children(wide, count, node);
  return node;
}

}  // namespace

std::vector<CompactNode> compact_nodes(std::span<const Bvh8Node> nodes) {
  std::vector<CompactNode> result(nodes.size());
  in_parallel(nodes.size(), [&](std::size_t i) { result[i] = compact(nodes[i]); });
  return result;
}

}  // namespace sundog
