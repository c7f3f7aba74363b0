// Binning, the choice of a plane, and the partition; see split.h.
#include "compile/split.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <vector>

namespace sundog {
namespace {

constexpr int max_bins = 32;
constexpr std::size_t parallel_size = 1u << 16;  // sets from this size on are worked on by several threads
constexpr std::size_t chunk_size = 1u << 13;
constexpr float least_extent = 1e-34f;  // below, a bin's width is no number to divide by

/// Bin number of a doubled centre, by axis.
struct BinMap {
  Lanes base, scale;
  int count;

  explicit BinMap(const Bounds& centers, std::size_t members)
      : base(centers.lower),
        count(members > 512  ? max_bins
              : members > 32 ? 16
                             : 8) {
    const Lanes extent = centers.upper - centers.lower;
    const float bins = static_cast<float>(count) * 0.9999f;
    for (int axis = 0; axis < 3; ++axis)
      scale[axis] = extent[axis] > least_extent ? bins / extent[axis] : 0.0f;
    scale[3] = 0;
  }
  bool usable(int axis) const { return scale[axis] > 0; }
  IntLanes operator()(Lanes center2) const {
    return __builtin_convertvector((center2 - base) * scale, IntLanes);
  }
};

struct Bins {
  std::array<std::array<Bounds, max_bins>, 3> box;
  std::array<std::array<u32, max_bins>, 3> members{};

  void add(const Ref& ref, const BinMap& map) {
    const IntLanes bin = map(ref.center2());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto slot = static_cast<std::size_t>(bin[axis]);
      box[axis][slot].extend(ref.box);
      ++members[axis][slot];
    }
  }
  void add(const Bins& other, int count) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t slot = 0; slot < static_cast<std::size_t>(count); ++slot) {
        box[axis][slot].extend(other.box[axis][slot]);
        members[axis][slot] += other.members[axis][slot];
      }
  }
};

void fill_bins(Bins& bins, std::span<const Ref> refs, const BinMap& map) {
  if (refs.size() < parallel_size) {
    for (const Ref& ref : refs) bins.add(ref, map);
    return;
  }
  bins = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, refs.size(), chunk_size), Bins{},
      [&](const tbb::blocked_range<std::size_t>& range, Bins sum) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) sum.add(refs[i], map);
        return sum;
      },
      [&](Bins a, const Bins& b) {
        a.add(b, map.count);
        return a;
      });
}

/// Members whose bin on `axis` is below `bin` go left.
struct Plane {
  int axis = -1, bin = 0;
  Bounds left, right;
};

/// Blocks that `members` fill.
float blocks(u32 members, const SplitSettings& settings) {
  return static_cast<float>((members + settings.block_width - 1) / settings.block_width);
}

/// The planes of one axis; keeps the best in `plane` and its cost in `least`. Equal costs: the more even
/// split.
void search_axis(const Bins& bins, int axis, int count, const SplitSettings& settings, Plane& plane,
                 float& least, u32& unevenness) {
  const auto& box = bins.box[static_cast<std::size_t>(axis)];
  const auto& members = bins.members[static_cast<std::size_t>(axis)];
  std::array<Bounds, max_bins> right;
  std::array<u32, max_bins> right_members;
  Bounds sum;
  u32 n = 0;
  for (auto i = static_cast<std::size_t>(count); i-- > 0;) {
    sum.extend(box[i]);
    right[i] = sum;
    right_members[i] = n += members[i];
  }
  sum = Bounds{};
  n = 0;
  for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i) {
    sum.extend(box[i - 1]);
    n += members[i - 1];
    if (n == 0 || right_members[i] == 0) continue;
    const float cost = half_area(sum, settings.area_scale) * blocks(n, settings) +
                       half_area(right[i], settings.area_scale) * blocks(right_members[i], settings);
    const u32 uneven = n > right_members[i] ? n - right_members[i] : right_members[i] - n;
    if (cost < least || (cost == least && uneven < unevenness)) {
      least = cost;
      unevenness = uneven;
      plane = {axis, static_cast<int>(i), sum, right[i]};
    }
  }
}

Plane find_plane(const RefSet& set, const BinMap& map, const SplitSettings& settings) {
  Plane plane;
  if (!map.usable(0) && !map.usable(1) && !map.usable(2)) return plane;
  Bins bins;
  fill_bins(bins, set.refs, map);
  float least = std::numeric_limits<float>::infinity();
  u32 unevenness = std::numeric_limits<u32>::max();
  for (int axis = 0; axis < 3; ++axis)
    if (map.usable(axis)) search_axis(bins, axis, map.count, settings, plane, least, unevenness);
  return plane;
}

/// Moves the members left of the plane to the front; returns their number, and the bounds of the centres.
std::size_t partition_serial(std::span<Ref> refs, const BinMap& map, const Plane& plane, Bounds& left,
                             Bounds& right) {
  std::size_t i = 0, j = refs.size();
  const auto is_left = [&](Lanes center2) { return map(center2)[plane.axis] < plane.bin; };
  while (true) {
    Lanes center{};
    while (i < j && is_left(center = refs[i].center2())) left.extend(center), ++i;
    if (i == j) return i;
    right.extend(center);
    while (i < --j && !is_left(center = refs[j].center2())) right.extend(center);
    if (i == j) return i;
    left.extend(center);
    std::swap(refs[i++], refs[j]);
  }
}

/// The same for large sets: chunks are counted, then scattered through a second array.
std::size_t partition_parallel(std::span<Ref> refs, const BinMap& map, const Plane& plane, Bounds& left,
                               Bounds& right) {
  struct Chunk {
    std::size_t left_count = 0;
    Bounds left, right;
  };
  std::vector<Chunk> chunks((refs.size() + chunk_size - 1) / chunk_size);
  const auto is_left = [&](Lanes center2) { return map(center2)[plane.axis] < plane.bin; };
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    Chunk chunk;
    for (const Ref& ref : refs.subspan(c * chunk_size, std::min(chunk_size, refs.size() - c * chunk_size))) {
      const Lanes center = ref.center2();
      const bool first = is_left(center);
      (first ? chunk.left : chunk.right).extend(center);
      chunk.left_count += first;
    }
    chunks[c] = chunk;
  });
  std::size_t left_count = 0;
  for (Chunk& chunk : chunks) {
    left.extend(chunk.left);
    right.extend(chunk.right);
    left_count += std::exchange(chunk.left_count, left_count);
  }
  std::vector<Ref> sorted(refs.size());
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    const std::size_t begin = c * chunk_size;
    std::size_t to_left = chunks[c].left_count, to_right = left_count + begin - to_left;
    for (const Ref& ref : refs.subspan(begin, std::min(chunk_size, refs.size() - begin)))
      sorted[is_left(ref.center2()) ? to_left++ : to_right++] = ref;
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, refs.size(), chunk_size), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) refs[i] = sorted[i];
  });
  return left_count;
}

RefSet bounds_of(std::span<Ref> refs, std::size_t begin, std::size_t end) {
  RefSet set{refs, {}, {}};
  for (std::size_t i = begin; i != end; ++i) {
    set.box.extend(refs[i].box);
    set.centers.extend(refs[i].center2());
  }
  return set;
}

}  // namespace

RefSet make_ref_set(std::span<Ref> refs) {
  if (refs.size() < parallel_size) return bounds_of(refs, 0, refs.size());
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, refs.size(), chunk_size), RefSet{refs, {}, {}},
      [&](const tbb::blocked_range<std::size_t>& range, RefSet sum) {
        const RefSet part = bounds_of(refs, range.begin(), range.end());
        sum.box.extend(part.box);
        sum.centers.extend(part.centers);
        return sum;
      },
      [](RefSet a, const RefSet& b) {
        a.box.extend(b.box);
        a.centers.extend(b.centers);
        return a;
      });
}

RefSplit split_by_area(const RefSet& set, const SplitSettings& settings) {
  const BinMap map(set.centers, set.refs.size());
  const Plane plane = find_plane(set, map, settings);
  if (plane.axis < 0) return split_by_median(set);
  RefSplit split;
  split.left.box = plane.left;
  split.right.box = plane.right;
  const auto partition = set.refs.size() < parallel_size ? partition_serial : partition_parallel;
  const std::size_t middle = partition(set.refs, map, plane, split.left.centers, split.right.centers);
  split.left.refs = set.refs.first(middle);
  split.right.refs = set.refs.subspan(middle);
  return split;
}

RefSplit split_by_median(const RefSet& set) {
  const Lanes extent = set.centers.upper - set.centers.lower;
  const int axis =
      extent[0] >= extent[1] ? (extent[0] >= extent[2] ? 0 : 2) : (extent[1] >= extent[2] ? 1 : 2);
  const std::size_t middle = set.refs.size() / 2;
  std::nth_element(set.refs.begin(), set.refs.begin() + static_cast<std::ptrdiff_t>(middle), set.refs.end(),
                   [axis](const Ref& a, const Ref& b) {
                     const float ca = a.center2()[axis], cb = b.center2()[axis];
                     return ca != cb ? ca < cb : a.prim() < b.prim();
                   });
  return {make_ref_set(set.refs.first(middle)), make_ref_set(set.refs.subspan(middle))};
}

}  // namespace sundog
