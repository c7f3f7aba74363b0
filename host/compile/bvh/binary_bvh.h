// The binary tree under a wide one, and for each of its nodes the least cost of turning it into 1 to 7 wide
// children.
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
  const Ref* refs = nullptr;   // of a node without children: its members, in order of their numbers
  u32 count = 0;               // members of the subtree; the halves of a cut triangle count apart
  BinaryNode* left = nullptr;  // both or neither
  BinaryNode* right = nullptr;
  /// cost[i]: least expected cost of this subtree as at most i children of a wide node (i = 1..7).
  std::array<float, 8> cost{};
  /// share[i]: of i children, the number that `left` becomes; 0: i - 1 children are as good. share[8]: as a
  /// wide node itself.
  std::array<std::uint8_t, 9> share{};
  bool leaf = false;  // as one child, it is a leaf of blocks (else a wide node)
};

/// Owns the nodes; they stay where they are.
class BinaryTree {
 public:
  /// `refs` are used until the end; `spare` places are free behind them. `balanced`: halved by number, not by
  /// area.
  BinaryTree(std::span<Ref> refs, std::size_t spare, const WideBvhSettings& settings, bool balanced);
  ~BinaryTree();
  const BinaryNode& root() const { return *root_; }

 private:
  struct Builder;
  std::unique_ptr<Builder> builder_;
  BinaryNode* root_ = nullptr;
};

}  // namespace sundog
