// Where to divide a set of boxes: binned surface area heuristic (Wald 2007, "On fast Construction of
// SAH-based Bounding Volume Hierarchies"), optionally with cuts through triangles (Stich, Friedrich and
// Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies"), with a median as the last resort. Every
// decision depends on the set alone, never on the order of its members, so a parallel build gives the tree of
// a serial one.
#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "compile/bounds.h"
#include "scene/description.h"

namespace sundog {

/// A set of refs that are consecutive in memory, with the bounds of its boxes and of its (doubled) centres.
struct RefSet {
  std::span<Ref> refs;
  Bounds box, centers;
  std::size_t spare = 0;  // places behind refs that are the set's own: room for the halves of cut triangles
};

/// Bounds of `refs`, in parallel when there are many.
RefSet make_ref_set(std::span<Ref> refs, std::size_t spare);

struct SplitSettings {
  u32 block_width = 8;         // members tested for the price of one
  float area_scale = 1;        // see half_area()
  float root_area = 1;         // half area of the tree's box
  std::span<Ref> all;          // every ref of the tree, and the spare places
  Ref* scratch = nullptr;      // as many, to be overwritten
  const Mesh* mesh = nullptr;  // the refs' triangles, when they may be cut
};

struct RefSplit {
  RefSet left, right;
};

/// Divides `set` (two members or more) where the binned SAH is least; where all centres coincide, in the
/// middle by number. Reorders the refs. Both parts have members.
RefSplit split_by_area(const RefSet& set, const SplitSettings& settings);

/// Halves `set` along the widest axis of its centres.
RefSplit split_by_median(const RefSet& set);

/// Divides `set` by a plane that cuts triangles in two, if that costs less than `least` and there is room.
/// Each part has fewer members than the set.
std::optional<RefSplit> split_in_space(const RefSet& set, const SplitSettings& settings, float least);

/// Relative price of `members` in a box: the blocks that they fill.
inline float blocks(std::size_t members, const SplitSettings& settings) {
  const std::size_t filled = (members + settings.block_width - 1) / settings.block_width;
  return static_cast<float>(filled);
}

/// Whether several threads should work on one set: it is large, and there are too few others for them.
bool share_work(std::size_t members, const SplitSettings& settings);

constexpr std::size_t split_chunk = 1u << 13;  // members a task takes then
constexpr float least_extent = 1e-34f;         // below, a bin's width is no number to divide by

/// The parts' places: left at the front of the set's memory, right behind left's share of the spare places.
RefSplit place_parts(const RefSet& set, std::size_t left_count, std::size_t right_count);

}  // namespace sundog
