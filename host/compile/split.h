// Where to divide a set of boxes: binned surface area heuristic (Wald 2007, "On fast Construction of
// SAH-based Bounding Volume Hierarchies"), with a median as the last resort. Every decision depends on the
// set alone, never on the order of its members, so a parallel build gives the tree of a serial one.
#pragma once
#include <cstddef>
#include <span>

#include "compile/bounds.h"

namespace sundog {

/// A set of refs that are consecutive in memory, with the bounds of its boxes and of its (doubled) centres.
struct RefSet {
  std::span<Ref> refs;
  Bounds box, centers;
};

/// Bounds of `refs`, in parallel when there are many.
RefSet make_ref_set(std::span<Ref> refs);

struct SplitSettings {
  u32 block_width = 8;   // members tested for the price of one
  float area_scale = 1;  // see half_area()
  std::span<Ref> all;    // every ref of the tree
  Ref* scratch;          // as many, to be overwritten
};

struct RefSplit {
  RefSet left, right;
};

/// Divides `set` (two members or more) where the binned SAH is least; where all centres coincide, in the
/// middle by number. Reorders the refs. Both parts have members.
RefSplit split_by_area(const RefSet& set, const SplitSettings& settings);

/// Halves `set` along the widest axis of its centres.
RefSplit split_by_median(const RefSet& set);

}  // namespace sundog
