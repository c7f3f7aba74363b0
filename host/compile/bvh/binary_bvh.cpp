// The recursive build, one task per subtree, and the dynamic program of the collapse on the way back up.
#include "compile/bvh/binary_bvh.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "compile/bvh/split.h"

namespace sundog {
namespace {

constexpr std::size_t task_size = 1u << 12;  // smaller subtrees are one task
constexpr int depth_limit = 64;              // deeper sets are halved, which bounds the recursion

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

}  // namespace

struct BinaryTree::Builder {
  const WideBvhSettings& settings;
  const bool balanced;
  SplitSettings split;
  tbb::enumerable_thread_specific<NodePool> pools;

  BinaryNode* build(const RefSet& set, int depth, NodePool& pool);
  void make_leaf(BinaryNode& node, std::span<Ref> refs) const;
  void collapse(BinaryNode& node) const;
  float blocks(u32 count) const {
    const u32 filled = (count + settings.block_width - 1) / settings.block_width;
    return static_cast<float>(filled);
  }
};

BinaryTree::BinaryTree(std::span<Ref> refs, std::size_t spare, const WideBvhSettings& settings,
                       bool balanced) {
  const RefSet all = make_ref_set(refs, spare);
  const auto scratch = std::make_unique_for_overwrite<Ref[]>(refs.size() + spare);
  SplitSettings split;
  split.block_width = settings.block_width;
  const Lanes extent = all.box.upper - all.box.lower;
  const float longest = std::max({extent[0], extent[1], extent[2]});
  if (longest > 0) split.area_scale = std::min(1 / longest, std::numeric_limits<float>::max());
  split.root_area = half_area(all.box, split.area_scale);
  split.all = {refs.data(), refs.size() + spare};
  split.scratch = scratch.get();
  split.mesh = settings.cut;
  builder_.reset(new Builder{settings, balanced, split, {}});
  root_ = builder_->build(all, 0, builder_->pools.local());
}

BinaryTree::~BinaryTree() = default;

BinaryNode* BinaryTree::Builder::build(const RefSet& set, int depth, NodePool& pool) {
  BinaryNode* node = pool.make();
  node->box = set.box;
  node->count = static_cast<u32>(set.refs.size());
  if (set.refs.size() <= settings.block_width) {
    make_leaf(*node, set.refs);
    return node;
  }
  const RefSplit parts = balanced || depth >= depth_limit ? split_by_median(set) : split_by_area(set, split);
  if (set.refs.size() < task_size) {
    node->left = build(parts.left, depth + 1, pool);
    node->right = build(parts.right, depth + 1, pool);
  } else {
    tbb::parallel_invoke([&] { node->left = build(parts.left, depth + 1, pools.local()); },
                         [&] { node->right = build(parts.right, depth + 1, pools.local()); });
  }
  node->count = node->left->count + node->right->count;
  collapse(*node);
  return node;
}

void BinaryTree::Builder::make_leaf(BinaryNode& node, std::span<Ref> refs) const {
  std::sort(refs.begin(), refs.end(), [](const Ref& a, const Ref& b) { return a.prim() < b.prim(); });
  node.refs = refs.data();
  node.leaf = true;
  node.cost.fill(half_area(node.box, split.area_scale) * settings.block_cost * blocks(node.count));
}

void BinaryTree::Builder::collapse(BinaryNode& node) const {
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
  const float area = half_area(node.box, split.area_scale);
  node.cost[1] = shared[8] + area * settings.node_cost;
  if (node.count <= settings.block_width * settings.max_leaf_blocks) {
    const float as_leaf = area * settings.block_cost * blocks(node.count);
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

}  // namespace sundog
