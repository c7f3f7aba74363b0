// Binning, the choice of a plane, and the partition; see split.h.
#include "compile/split.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

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
  std::array<std::array<Bounds, max_bins>, 3>
      box;  // not initialised beyond the bins in use: most sets are small
  std::array<std::array<u32, max_bins>, 3> members;

  explicit Bins(int count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::fill_n(box[axis].begin(), count, Bounds::none());
      std::fill_n(members[axis].begin(), count, 0u);
    }
  }
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

/// Whether several threads should work on one set: it is large, and there are too few others for them.
bool share_work(std::size_t members, const SplitSettings& settings) {
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return members >= parallel_size && members * threads > settings.all.size();
}

void fill_bins(Bins& bins, std::span<const Ref> refs, const BinMap& map, bool parallel) {
  if (!parallel) {
    for (const Ref& ref : refs) bins.add(ref, map);
    return;
  }
  bins = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, refs.size(), chunk_size), Bins(map.count),
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
  Bounds sum = Bounds::none();
  u32 n = 0;
  for (auto i = static_cast<std::size_t>(count); i-- > 0;) {
    sum.extend(box[i]);
    right[i] = sum;
    right_members[i] = n += members[i];
  }
  sum = Bounds::none();
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
  Bins bins(map.count);
  fill_bins(bins, set.refs, map, share_work(set.refs.size(), settings));
  float least = std::numeric_limits<float>::infinity();
  u32 unevenness = std::numeric_limits<u32>::max();
  for (int axis = 0; axis < 3; ++axis)
    if (map.usable(axis)) search_axis(bins, axis, map.count, settings, plane, least, unevenness);
  return plane;
}

/// A partition's outcome: how many went left, and the bounds of the centres, [0] left and [1] right.
struct Parts {
  std::size_t left_count = 0;
  std::array<Bounds, 2> centers{Bounds::none(), Bounds::none()};
};

/// Which side of a plane a centre is on: 0 left, 1 right.
struct Side {
  const BinMap& map;
  const Plane& plane;
  std::size_t operator()(Lanes center2) const { return map(center2)[plane.axis] >= plane.bin; }
};

/// Moves the members left of the plane to the front. Each ref is written to both sides and one of them
/// advances: no branch to mispredict.
Parts partition_serial(std::span<Ref> refs, Ref* scratch, const Side& side_of) {
  Parts parts;
  std::size_t right_count = 0;
  for (const Ref ref : refs) {
    const Lanes center = ref.center2();
    const std::size_t side = side_of(center);
    refs[parts.left_count] = ref;
    scratch[right_count] = ref;
    parts.left_count += 1 - side;
    right_count += side;
    parts.centers[side].extend(center);
  }
  std::copy(scratch, scratch + right_count, refs.begin() + static_cast<std::ptrdiff_t>(parts.left_count));
  return parts;
}

/// The same for large sets: chunks are counted, then scattered through the scratch array.
Parts partition_parallel(std::span<Ref> refs, Ref* scratch, const Side& side_of) {
  std::vector<Parts> chunks((refs.size() + chunk_size - 1) / chunk_size);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    Parts chunk;
    for (const Ref& ref : refs.subspan(c * chunk_size, std::min(chunk_size, refs.size() - c * chunk_size))) {
      const Lanes center = ref.center2();
      const std::size_t side = side_of(center);
      chunk.centers[side].extend(center);
      chunk.left_count += 1 - side;
    }
    chunks[c] = chunk;
  });
  Parts parts;
  for (Parts& chunk : chunks) {
    for (std::size_t side = 0; side < 2; ++side) parts.centers[side].extend(chunk.centers[side]);
    parts.left_count += std::exchange(chunk.left_count, parts.left_count);
  }
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    const std::size_t begin = c * chunk_size;
    std::array<std::size_t, 2> to = {chunks[c].left_count, parts.left_count + begin - chunks[c].left_count};
    for (const Ref& ref : refs.subspan(begin, std::min(chunk_size, refs.size() - begin)))
      scratch[to[side_of(ref.center2())]++] = ref;
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, refs.size(), chunk_size), [&](const auto& range) {
    std::copy(scratch + range.begin(), scratch + range.end(),
              refs.begin() + static_cast<std::ptrdiff_t>(range.begin()));
  });
  return parts;
}

RefSet bounds_of(std::span<Ref> refs, std::size_t begin, std::size_t end) {
  RefSet set{refs, Bounds::none(), Bounds::none()};
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
      tbb::blocked_range<std::size_t>(0, refs.size(), chunk_size),
      RefSet{refs, Bounds::none(), Bounds::none()},
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
  const auto partition = share_work(set.refs.size(), settings) ? partition_parallel : partition_serial;
  const Parts parts =
      partition(set.refs, settings.scratch + (set.refs.data() - settings.all.data()), Side{map, plane});
  split.left.refs = set.refs.first(parts.left_count);
  split.right.refs = set.refs.subspan(parts.left_count);
  split.left.centers = parts.centers[0];
  split.right.centers = parts.centers[1];
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
