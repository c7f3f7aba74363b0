// A tree of boxes that finds overlaps.
#pragma once
#include <span>
#include <vector>

#include "compile/bounds.h"

namespace sundog {

/// A box with a tolerance; two boxes use the larger `slack` of both.
struct LooseBox {
  Bounds box;
  double slack;
};

/// Whether `a` and `b` overlap or are at most `slack` apart along each axis.
bool overlap(const Bounds& a, const Bounds& b, double slack);

/// A binary tree over boxes, which may be unbounded.
class BoxTree {
 public:
  explicit BoxTree(std::span<const LooseBox> boxes);

  /// Indices greater than `after` of the boxes that overlap `wanted` within the larger slack of both, in
  /// ascending order.
  void find(const LooseBox& wanted, u32 after, std::vector<u32>& found) const;

 private:
  struct Node {
    LooseBox all;
    u32 first, count;  // a leaf's range of order_
    u32 right;         // the left child follows its parent
  };
  u32 build(u32 first, u32 count);

  std::span<const LooseBox> boxes_;
  std::vector<u32> order_;
  std::vector<Node> nodes_;
};

}  // namespace sundog
