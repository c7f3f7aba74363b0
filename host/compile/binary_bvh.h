// The binary tree under a wide one, and for each of its nodes the least cost of turning it into 1 to 7 wide
// children.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compile/bounds.h"
#include "compile/wide_bvh.h"

namespace sundog {

/// A node over members[first, first + count) of the tree's order.
struct BinaryNode {
  Bounds box;
  u32 first = 0, count = 0;
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
  BinaryTree(std::span<Ref> refs, const WideBvhSettings& settings, bool balanced);
  ~BinaryTree();
  const BinaryNode& root() const { return *root_; }
  std::vector<u32> take_members() { return std::move(members_); }

 private:
  struct Builder;
  std::unique_ptr<Builder> builder_;
  std::vector<u32> members_;
  BinaryNode* root_ = nullptr;
};

}  // namespace sundog
