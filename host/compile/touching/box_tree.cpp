// Splits by count along the longest axis of the centres; searches with a stack and sorts the boxes it finds.
#include "compile/touching/box_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace sundog {
namespace {

constexpr u32 leaf_size = 4;

/// Twice the centre; unbounded boxes are clipped to large numbers.
Lanes middle2(const Bounds& box) {
  constexpr float far = 1e37f;
  return lanes_max(box.lower, lanes(-far)) + lanes_min(box.upper, lanes(far));
}

}  // namespace

bool overlap(const Bounds& a, const Bounds& b, double slack) {
  for (int axis = 0; axis < 3; ++axis)
    if (double(a.lower[axis]) > double(b.upper[axis]) + slack ||
        double(b.lower[axis]) > double(a.upper[axis]) + slack)
      return false;
  return true;
}

BoxTree::BoxTree(std::span<const LooseBox> boxes) : boxes_(boxes), order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (!order_.empty()) build(0, static_cast<u32>(order_.size()));
}

u32 BoxTree::build(u32 first, u32 count) {
  const auto index = static_cast<u32>(nodes_.size());
  LooseBox all{Bounds::none(), 0};
  Bounds middles = Bounds::none();
  for (u32 i = first; i < first + count; ++i) {
    all.box.extend(boxes_[order_[i]].box);
    all.slack = std::max(all.slack, boxes_[order_[i]].slack);
    middles.extend(middle2(boxes_[order_[i]].box));
  }
  nodes_.push_back({all, first, count, 0});
  if (count <= leaf_size) return index;
  const Lanes extent = middles.upper - middles.lower;
  const int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : extent[1] >= extent[2] ? 1 : 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](u32 a, u32 b) { return middle2(boxes_[a].box)[axis] < middle2(boxes_[b].box)[axis]; });
  nodes_[index].count = 0;
  build(first, count / 2);
  nodes_[index].right = build(first + count / 2, count - count / 2);
  return index;
}

void BoxTree::find(const LooseBox& wanted, u32 after, std::vector<u32>& found) const {
  found.clear();
  if (nodes_.empty()) return;
  const auto meets = [&](const LooseBox& other) {
    return overlap(wanted.box, other.box, std::max(wanted.slack, other.slack));
  };
  std::array<u32, 64> waiting;  // the tree is balanced: no deeper than 32
  std::size_t size = 0;
  waiting[size++] = 0;
  while (size > 0) {
    const u32 index = waiting[--size];
    const Node& node = nodes_[index];
    if (!meets(node.all)) continue;
    if (node.right != 0) {
      waiting[size++] = node.right;
      waiting[size++] = index + 1;
      continue;
    }
    for (u32 i = node.first; i < node.first + node.count; ++i)
      if (order_[i] > after && meets(boxes_[order_[i]])) found.push_back(order_[i]);
  }
  std::ranges::sort(found);
}

}  // namespace sundog
