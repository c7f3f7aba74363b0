// Builds an 8-wide BVH: a binary tree by surface area (split.h), collapsed by cost to nodes of eight children
// (Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
// section 3.2).
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "compile/bounds.h"
#include "scene/description.h"
#include "shared/bvh.h"

namespace sundog {

/// A tree that may need a deeper traversal stack is rebuilt as a balanced one.
constexpr u32 stack_limit = 96;

struct WideBvhSettings {
  u32 block_width = 8;       // members of a leaf block (triangles: 8; instances: 1)
  u32 max_leaf_blocks = 16;  // maximum blocks per leaf
  float node_cost = 1, block_cost = 1;
  const Mesh* cut = nullptr;  // triangles that may be split, which puts a primitive into several leaves
  float spare = 0.3f;         // extra refs that splits may add, relative to the initial number
};

/// The tree's topology. Child words count from node 0 and block 0 of this tree. A node's inner children are
/// consecutive, and so are its leaves' blocks.
struct WideBvh {
  struct Block {
    u32 first, count;  // members[first, first + count)
  };
  std::vector<Bvh8Node> nodes;  // [0] is the root; never empty
  std::vector<Block> blocks;
  std::vector<u32> members;     // primitive numbers in leaf order
  Bounds box = Bounds::none();  // empty without members
};

/// Builds the tree over `count` members, whose refs `fill` writes (indices below 2^27; it may be called
/// twice). Deterministic for any number of threads.
WideBvh build_wide_bvh(std::size_t count, const std::function<void(std::span<Ref>)>& fill,
                       const WideBvhSettings& settings);

/// Expected cost of a ray that crosses the root's box: 1 per visited node, and leaf_cost(first block, number
/// of blocks) per visited leaf.
double expected_cost(std::span<const Bvh8Node> nodes, u32 root,
                     const std::function<double(u32 first, u32 count)>& leaf_cost);

Bvh8Node empty_node();
Bounds child_bounds(const Bvh8Node& node, u32 slot);
/// Bounds of all children.
Bounds node_bounds(const Bvh8Node& node);

/// Worst-case size of a traversal stack, if each visited node pushes all children but one.
u32 stack_need(std::span<const Bvh8Node> nodes, u32 root);

}  // namespace sundog
