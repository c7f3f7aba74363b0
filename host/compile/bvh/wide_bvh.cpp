// Computes each binary node's least cost as 1 to 7 wide children on the way up, then lays out Bvh8Nodes and
// leaf blocks; rebuilds a tree that is too deep for the stack with median splits.
#include "compile/bvh/wide_bvh.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "compile/bvh/split.h"

namespace sundog {
namespace {

constexpr std::size_t task_size = 1u << 12;  // smaller subtrees are one task
constexpr int depth_limit = 64;              // deeper sets are halved, which bounds the recursion

struct BinaryNode {
  Bounds box;
  const Ref* refs = nullptr;   // a leaf's members, sorted by index
  u32 count = 0;               // members of the subtree; the parts of a split triangle count separately
  BinaryNode* left = nullptr;  // both or neither
  BinaryNode* right = nullptr;
  /// cost[i]: minimum expected cost of this subtree as at most i children of a wide node (i = 1..7).
  std::array<float, 8> cost{};
  /// share[i]: how many of i children come from `left`; 0: i - 1 children are as cheap. share[8]: as a wide
  /// node.
  std::array<std::uint8_t, 9> share{};
  bool leaf = false;  // whether a single child is a leaf of blocks, not a wide node
};

/// Allocates nodes from chunks; one pool per thread.
class NodePool {
 public:
  BinaryNode* make() {
    if (used_ == chunk) {
      chunks_.push_back(std::make_unique<std::array<BinaryNode, chunk>>());
      used_ = 0;
    }
    return &(*chunks_.back())[used_++];
  }

 private:
  static constexpr std::size_t chunk = 256;
  std::vector<std::unique_ptr<std::array<BinaryNode, chunk>>> chunks_;
  std::size_t used_ = chunk;
};

/// The recursive build, one task per subtree, and the dynamic program of the collapse on the way back up.
/// Owns the nodes; their addresses are stable.
class BinaryTree {
 public:
  /// Reorders `refs`, which must outlive this; `spare` free places follow them. `balanced`: split by count,
  /// not by area.
  BinaryTree(std::span<Ref> refs, std::size_t spare, const WideBvhSettings& settings, bool balanced)
      : settings_(settings), balanced_(balanced) {
    const RefSet all = make_ref_set(refs, spare);
    const auto scratch = std::make_unique_for_overwrite<Ref[]>(refs.size() + spare);
    split_.block_width = settings.block_width;
    const Lanes extent = all.box.upper - all.box.lower;
    const float longest = std::max({extent[0], extent[1], extent[2]});
    if (longest > 0) split_.area_scale = std::min(1 / longest, std::numeric_limits<float>::max());
    split_.root_area = half_area(all.box, split_.area_scale);
    split_.all = {refs.data(), refs.size() + spare};
    split_.scratch = scratch.get();
    split_.mesh = settings.cut;
    root_ = build(all, 0, pools_.local());
  }
  const BinaryNode& root() const { return *root_; }

 private:
  BinaryNode* build(const RefSet& set, int depth, NodePool& pool) {
    BinaryNode* node = pool.make();
    node->box = set.box;
    node->count = static_cast<u32>(set.refs.size());
    if (set.refs.size() <= settings_.block_width) {
      make_leaf(*node, set.refs);
      return node;
    }
    const RefSplit parts =
        balanced_ || depth >= depth_limit ? split_by_median(set) : split_by_area(set, split_);
    if (set.refs.size() < task_size) {
      node->left = build(parts.left, depth + 1, pool);
      node->right = build(parts.right, depth + 1, pool);
    } else {
      tbb::parallel_invoke([&] { node->left = build(parts.left, depth + 1, pools_.local()); },
                           [&] { node->right = build(parts.right, depth + 1, pools_.local()); });
    }
    node->count = node->left->count + node->right->count;
    collapse(*node);
    return node;
  }

  void make_leaf(BinaryNode& node, std::span<Ref> refs) const {
    std::sort(refs.begin(), refs.end(), [](const Ref& a, const Ref& b) { return a.prim() < b.prim(); });
    node.refs = refs.data();
    node.leaf = true;
    node.cost.fill(half_area(node.box, split_.area_scale) * settings_.block_cost * blocks(node.count));
  }

  void collapse(BinaryNode& node) const {
    const BinaryNode &left = *node.left, &right = *node.right;
    std::array<float, 9> shared;
    for (std::size_t i = 2; i <= 8; ++i) {
      shared[i] = std::numeric_limits<float>::infinity();
      for (std::size_t k = 1; k < i; ++k)
        if (const float cost = left.cost[k] + right.cost[i - k]; cost < shared[i]) {
          shared[i] = cost;
          node.share[i] = static_cast<std::uint8_t>(k);
        }
    }
    const float area = half_area(node.box, split_.area_scale);
    node.cost[1] = shared[8] + area * settings_.node_cost;
    if (node.count <= settings_.block_width * settings_.max_leaf_blocks) {
      const float as_leaf = area * settings_.block_cost * blocks(node.count);
      if (as_leaf <= node.cost[1]) {
        node.cost[1] = as_leaf;
        node.leaf = true;
      }
    }
    for (std::size_t i = 2; i < 8; ++i) {
      node.cost[i] = shared[i];
      if (node.cost[i - 1] <= shared[i]) {
        node.cost[i] = node.cost[i - 1];
        node.share[i] = 0;
      }
    }
  }

  float blocks(u32 count) const {
    const u32 filled = (count + settings_.block_width - 1) / settings_.block_width;
    return static_cast<float>(filled);
  }

  const WideBvhSettings& settings_;
  const bool balanced_;
  SplitSettings split_;
  tbb::enumerable_thread_specific<NodePool> pools_;
  BinaryNode* root_ = nullptr;
};

void set_bounds(Bvh8Node& node, u32 slot, const Bounds& box) {
  node.lower_x[slot] = box.lower[0];
  node.lower_y[slot] = box.lower[1];
  node.lower_z[slot] = box.lower[2];
  node.upper_x[slot] = box.upper[0];
  node.upper_y[slot] = box.upper[1];
  node.upper_z[slot] = box.upper[2];
}

/// The children of a wide node: up to eight binary nodes.
struct Children {
  std::array<const BinaryNode*, BVH_WIDTH> node;
  std::size_t count = 0;

  void gather(const BinaryNode& binary, std::size_t slots) {
    while (slots > 1 && slots < 8 && binary.left && binary.share[slots] == 0) --slots;
    if (slots == 1 || !binary.left) {
      node[count++] = &binary;
      return;
    }
    gather(*binary.left, binary.share[slots]);
    gather(*binary.right, slots - binary.share[slots]);
  }
};

class Layout {
 public:
  Layout(WideBvh& tree, u32 block_width) : tree_(tree), block_width_(block_width) {}

  void root(const BinaryNode& binary) {
    tree_.nodes.emplace_back();
    Children children;
    if (binary.leaf)
      children.gather(binary, 1);
    else
      children.gather(binary, 8);
    node(0, children);
  }

 private:
  void node(u32 index, const Children& children) {
    Bvh8Node wide = empty_node();
    const auto first_inner = static_cast<u32>(tree_.nodes.size());
    u32 inner = 0;
    for (u32 slot = 0; slot < children.count; ++slot) {
      const BinaryNode& child = *children.node[slot];
      set_bounds(wide, slot, child.box);
      wide.child[slot] = child.leaf ? leaf(child) : first_inner + inner++;
      wide.valid |= 1u << slot;
    }
    tree_.nodes.resize(tree_.nodes.size() + inner);
    tree_.nodes[index] = wide;
    inner = 0;
    for (u32 slot = 0; slot < children.count; ++slot)
      if (!children.node[slot]->leaf) {
        Children grandchildren;
        grandchildren.gather(*children.node[slot], 8);
        node(first_inner + inner++, grandchildren);
      }
  }

  u32 leaf(const BinaryNode& binary) {
    const auto first = static_cast<u32>(tree_.blocks.size());
    const auto begin = static_cast<u32>(tree_.members.size());
    take_members(binary);
    if (binary.left) {  // merged leaves may contain both parts of a split triangle
      const auto from = tree_.members.begin() + begin;
      std::sort(from, tree_.members.end());
      tree_.members.erase(std::unique(from, tree_.members.end()), tree_.members.end());
    }
    const auto end = static_cast<u32>(tree_.members.size());
    for (u32 i = begin; i < end; i += block_width_)
      tree_.blocks.push_back({i, std::min(block_width_, end - i)});
    const auto count = static_cast<u32>(tree_.blocks.size()) - first;
    return BVH_LEAF | (count - 1) << BVH_LEAF_SHIFT | first;
  }

  void take_members(const BinaryNode& binary) {
    if (binary.left) {
      take_members(*binary.left);
      take_members(*binary.right);
      return;
    }
    for (u32 i = 0; i < binary.count; ++i)
      if (i == 0 || binary.refs[i].prim() != binary.refs[i - 1].prim())
        tree_.members.push_back(binary.refs[i].prim());
  }

  WideBvh& tree_;
  u32 block_width_;
};

double area(const Bounds& box) {
  const double x = double(box.upper[0]) - double(box.lower[0]);
  const double y = double(box.upper[1]) - double(box.lower[1]);
  const double z = double(box.upper[2]) - double(box.lower[2]);
  return x * (y + z) + y * z;
}

}  // namespace

Bvh8Node empty_node() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Bvh8Node node{};
  for (u32 slot = 0; slot < BVH_WIDTH; ++slot) {
    node.lower_x[slot] = node.lower_y[slot] = node.lower_z[slot] = inf;
    node.upper_x[slot] = node.upper_y[slot] = node.upper_z[slot] = -inf;
    node.child[slot] = BVH_EMPTY;
  }
  return node;
}

Bounds child_bounds(const Bvh8Node& node, u32 slot) {
  return {Lanes{node.lower_x[slot], node.lower_y[slot], node.lower_z[slot], 0},
          Lanes{node.upper_x[slot], node.upper_y[slot], node.upper_z[slot], 0}};
}

Bounds node_bounds(const Bvh8Node& node) {
  Bounds box = Bounds::none();
  for (u32 slot = 0; slot < BVH_WIDTH && (node.valid >> slot & 1u); ++slot)
    box.extend(child_bounds(node, slot));
  return box;
}

WideBvh build_wide_bvh(std::size_t count, const std::function<void(std::span<Ref>)>& fill,
                       const WideBvhSettings& settings) {
  WideBvh tree;
  if (count == 0) {
    tree.nodes.push_back(empty_node());
    return tree;
  }
  const auto spare = settings.cut ? static_cast<std::size_t>(settings.spare * static_cast<float>(count)) : 0;
  const auto refs = std::make_unique_for_overwrite<Ref[]>(count + spare);
  for (const bool balanced : {false, true}) {
    fill({refs.get(), count});
    const BinaryTree binary({refs.get(), count}, spare, settings, balanced);
    tree = WideBvh{};
    tree.box = binary.root().box;
    tree.members.reserve(count);
    Layout(tree, settings.block_width).root(binary.root());
    if (stack_need(tree.nodes, 0) <= stack_limit) break;
  }
  return tree;
}

double expected_cost(std::span<const Bvh8Node> nodes, u32 root,
                     const std::function<double(u32 first, u32 count)>& leaf_cost) {
  const double root_area = area(node_bounds(nodes[root]));
  const std::function<double(u32, double)> cost = [&](u32 index, double share) {
    const Bvh8Node& node = nodes[index];
    double sum = share;
    for (u32 slot = 0; slot < BVH_WIDTH && (node.valid >> slot & 1u); ++slot) {
      const double part = root_area > 0 ? area(child_bounds(node, slot)) / root_area : 1.0;
      const u32 child = node.child[slot];
      if (child & BVH_LEAF)
        sum += part * leaf_cost(child & BVH_FIRST_MASK, (child >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK) + 1);
      else
        sum += cost(child, part);
    }
    return sum;
  };
  return cost(root, 1.0);
}

u32 stack_need(std::span<const Bvh8Node> nodes, u32 root) {
  const Bvh8Node& node = nodes[root];
  u32 count = 0, deepest = 0;
  for (; count < BVH_WIDTH && (node.valid >> count & 1u); ++count)
    if (!(node.child[count] & BVH_LEAF)) deepest = std::max(deepest, stack_need(nodes, node.child[count]));
  return count == 0 ? 0 : count - 1 + deepest;
}

}  // namespace sundog
