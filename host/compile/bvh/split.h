// Splits a set of boxes: binned surface area heuristic (Wald 2007, "On fast Construction of SAH-based
// Bounding Volume Hierarchies"), optional splits of triangles (Stich, Friedrich and Dietrich 2009, "Spatial
// Splits in Bounding Volume Hierarchies"), and a median as the last resort. Every decision depends only on
// the set, not on the order of its members, so parallel and serial builds give the same tree.
#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "compile/bounds.h"
#include "scene/description.h"

namespace sundog {

/// Consecutive refs, with the bounds of their boxes and of their (doubled) centres.
struct RefSet {
  std::span<Ref> refs;
  Bounds box, centers;
  std::size_t spare = 0;  // free places after refs, for the parts of split triangles
};

/// Computes the bounds of `refs`, in parallel for large sets.
RefSet make_ref_set(std::span<Ref> refs, std::size_t spare);

struct SplitSettings {
  u32 block_width = 8;         // members tested at the cost of one
  float area_scale = 1;        // see half_area()
  float root_area = 1;         // half area of the root's box
  std::span<Ref> all;          // all refs of the tree, and the spare places
  Ref* scratch = nullptr;      // a buffer of the same size
  const Mesh* mesh = nullptr;  // the refs' triangles, if they may be split
};

struct RefSplit {
  RefSet left, right;
};

/// Splits `set` (two or more members) at the lowest binned SAH cost, or by count if all centres coincide.
/// Reorders the refs. Neither part is empty.
RefSplit split_by_area(const RefSet& set, const SplitSettings& settings);

/// Splits `set` in halves along the widest axis of its centres.
RefSplit split_by_median(const RefSet& set);

/// Splits `set` by a plane that splits triangles, if that costs less than `least` and there is room. Each
/// part is smaller than the set.
std::optional<RefSplit> split_in_space(const RefSet& set, const SplitSettings& settings, float least);

/// Relative cost of `members` in a box: the number of blocks they fill.
inline float blocks(std::size_t members, const SplitSettings& settings) {
  const std::size_t filled = (members + settings.block_width - 1) / settings.block_width;
  return static_cast<float>(filled);
}

/// Whether several threads should share one set: it is large, and there are too few other sets.
bool share_work(std::size_t members, const SplitSettings& settings);

constexpr std::size_t split_chunk = 1u << 13;  // members per task of a shared set
constexpr float least_extent = 1e-34f;         // smaller extents are not divided into bins

/// Places the parts: left at the front of the set's memory, right after left's portion of the spare places.
RefSplit place_parts(const RefSet& set, std::size_t left_count, std::size_t right_count);

}  // namespace sundog
