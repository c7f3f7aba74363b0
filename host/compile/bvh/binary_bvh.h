// The binary tree under a wide BVH, with each node's minimum cost of becoming 1 to 7 wide children.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compile/bounds.h"
#include "compile/bvh/wide_bvh.h"

namespace sundog {

struct BinaryNode {
  Bounds box;
  const Ref* refs = nullptr;   // of a leaf: its members, sorted by index
  u32 count = 0;               // members of the subtree; the parts of a split triangle count separately
  BinaryNode* left = nullptr;  // both or neither
  BinaryNode* right = nullptr;
  /// cost[i]: minimum expected cost of this subtree as at most i children of a wide node (i = 1..7).
  std::array<float, 8> cost{};
  /// share[i]: how many of i children `left` becomes; 0: i - 1 children are as good. share[8]: as a wide
  /// node.
  std::array<std::uint8_t, 9> share{};
  bool leaf = false;  // as a single child: a leaf of blocks, else a wide node
};

/// Owns the nodes; their addresses are stable.
class BinaryTree {
 public:
  /// Reorders `refs`, which must outlive this; `spare` free places follow them. `balanced`: split by count,
  /// not by area.
  BinaryTree(std::span<Ref> refs, std::size_t spare, const WideBvhSettings& settings, bool balanced);
  ~BinaryTree();
  const BinaryNode& root() const { return *root_; }

 private:
  struct Builder;
  std::unique_ptr<Builder> builder_;
  BinaryNode* root_ = nullptr;
};

}  // namespace sundog
