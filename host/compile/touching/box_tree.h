// Which of many boxes overlap a box, without looking at each.
#pragma once
#include <span>
#include <vector>

#include "compile/bounds.h"

namespace sundog {

/// A box, and how far around it others still overlap it: `slack`, or theirs where that is more.
struct LooseBox {
  Bounds box;
  double slack;
};

/// Whether `a` and `b` overlap or are apart by no more than `slack` along each axis.
bool overlap(const Bounds& a, const Bounds& b, double slack);

/// A binary tree over boxes, which may be without bounds.
class BoxTree {
 public:
  explicit BoxTree(std::span<const LooseBox> boxes);

  /// The numbers of the boxes that overlap `wanted` by the greater slack of both, and that are greater than
  /// `after`, in ascending order.
  void find(const LooseBox& wanted, u32 after, std::vector<u32>& found) const;

 private:
  struct Node {
    LooseBox all;
    u32 first, count;  // of a leaf, in order_
    u32 right;         // the left child follows its parent
  };
  u32 build(u32 first, u32 count);

  std::span<const LooseBox> boxes_;
  std::vector<u32> order_;
  std::vector<Node> nodes_;
};

}  // namespace sundog
