// Splits a set of boxes: bins their centres, chooses the cheapest plane and partitions the boxes.
#include "compile/bvh/split.h"

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
constexpr std::size_t parallel_size = 1u << 16;  // larger sets use several threads

/// Maps a doubled centre to its bin along each axis.
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
  std::array<std::array<Bounds, max_bins>, 3> box;  // unused bins are not initialised: most sets are small
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

void fill_bins(Bins& bins, std::span<const Ref> refs, const BinMap& map, bool parallel) {
  if (!parallel) {
    for (const Ref& ref : refs) bins.add(ref, map);
    return;
  }
  bins = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, refs.size(), split_chunk), Bins(map.count),
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
  float cost = std::numeric_limits<float>::infinity();
  u32 unevenness = 0;
  Bounds left, right;
};

/// Evaluates the planes of one axis and keeps the best in `plane`; ties go to the more even split.
void search_axis(const Bins& bins, int axis, int count, const SplitSettings& settings, Plane& plane) {
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
    if (cost < plane.cost || (cost == plane.cost && uneven < plane.unevenness))
      plane = {axis, static_cast<int>(i), cost, uneven, sum, right[i]};
  }
}

Plane find_plane(const RefSet& set, const BinMap& map, const SplitSettings& settings) {
  Plane plane;
  if (!map.usable(0) && !map.usable(1) && !map.usable(2)) return plane;
  Bins bins(map.count);
  fill_bins(bins, set.refs, map, share_work(set.refs.size(), settings));
  for (int axis = 0; axis < 3; ++axis)
    if (map.usable(axis)) search_axis(bins, axis, map.count, settings, plane);
  return plane;
}

/// A partition's result: the number of left members, and bounds of the centres, [0] left and [1] right.
struct Parts {
  std::size_t left_count = 0;
  std::array<Bounds, 2> centers{Bounds::none(), Bounds::none()};
};

/// Minimum overlap of the boxes, relative to the tree's box, for trying to split triangles.
constexpr float least_overlap = 1e-4f;

bool overlaps(const Plane& plane, const SplitSettings& settings) {
  const Bounds common{lanes_max(plane.left.lower, plane.right.lower),
                      lanes_min(plane.left.upper, plane.right.upper)};
  for (int axis = 0; axis < 3; ++axis)
    if (common.lower[axis] > common.upper[axis]) return false;
  return half_area(common, settings.area_scale) > least_overlap * settings.root_area;
}

/// The side of a centre: 0 left, 1 right.
struct Side {
  const BinMap& map;
  const Plane& plane;
  std::size_t operator()(Lanes center2) const { return map(center2)[plane.axis] >= plane.bin; }
};

/// Moves left members to the front and the others to `scratch`. Writes each ref to both and advances one of
/// them, which avoids mispredicted branches.
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
  return parts;
}

void copy_parallel(const Ref* from, std::size_t count, Ref* to) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, split_chunk), [&](const auto& range) {
    std::copy(from + range.begin(), from + range.end(), to + range.begin());
  });
}

/// partition_serial() in parallel for large sets: counts chunks, then scatters them to `scratch`, the left
/// ones last.
Parts partition_parallel(std::span<Ref> refs, Ref* scratch, const Side& side_of) {
  std::vector<Parts> chunks((refs.size() + split_chunk - 1) / split_chunk);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    Parts chunk;
    for (const Ref& ref :
         refs.subspan(c * split_chunk, std::min(split_chunk, refs.size() - c * split_chunk))) {
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
    const std::size_t begin = c * split_chunk;
    const std::size_t right_count = refs.size() - parts.left_count;
    std::array<std::size_t, 2> to = {right_count + chunks[c].left_count, begin - chunks[c].left_count};
    for (const Ref& ref : refs.subspan(begin, std::min(split_chunk, refs.size() - begin)))
      scratch[to[side_of(ref.center2())]++] = ref;
  });
  copy_parallel(scratch + (refs.size() - parts.left_count), parts.left_count, refs.data());
  return parts;
}

RefSet bounds_of(std::span<Ref> refs, std::size_t begin, std::size_t end) {
  RefSet set{refs, Bounds::none(), Bounds::none(), 0};
  for (std::size_t i = begin; i != end; ++i) {
    set.box.extend(refs[i].box);
    set.centers.extend(refs[i].center2());
  }
  return set;
}

}  // namespace

bool share_work(std::size_t members, const SplitSettings& settings) {
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return members >= parallel_size && members * threads > settings.all.size();
}

RefSplit place_parts(const RefSet& set, std::size_t left_count, std::size_t right_count) {
  const std::size_t spare = set.refs.size() + set.spare - left_count - right_count;
  const std::size_t left_spare = spare * left_count / (left_count + right_count);
  RefSplit split;
  Ref* const first = set.refs.data();
  split.left.refs = {first, left_count};
  split.left.spare = left_spare;
  split.right.refs = {first + left_count + left_spare, right_count};
  split.right.spare = spare - left_spare;
  return split;
}

RefSet make_ref_set(std::span<Ref> refs, std::size_t spare) {
  RefSet set{refs, Bounds::none(), Bounds::none(), spare};
  const auto add = [](RefSet sum, const RefSet& part) {
    sum.box.extend(part.box);
    sum.centers.extend(part.centers);
    return sum;
  };
  if (refs.size() < parallel_size) return add(set, bounds_of(refs, 0, refs.size()));
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, refs.size(), split_chunk), set,
      [&](const tbb::blocked_range<std::size_t>& range, const RefSet& sum) {
        return add(sum, bounds_of(refs, range.begin(), range.end()));
      },
      add);
}

RefSplit split_by_area(const RefSet& set, const SplitSettings& settings) {
  const BinMap map(set.centers, set.refs.size());
  const Plane plane = find_plane(set, map, settings);
  if (settings.mesh && (plane.axis < 0 || overlaps(plane, settings)))
    if (const auto cut = split_in_space(set, settings, plane.cost)) return *cut;
  if (plane.axis < 0) return split_by_median(set);

  const bool shared = share_work(set.refs.size(), settings);
  Ref* const scratch = settings.scratch + (set.refs.data() - settings.all.data());
  const Parts parts = (shared ? partition_parallel : partition_serial)(set.refs, scratch, Side{map, plane});
  RefSplit split = place_parts(set, parts.left_count, set.refs.size() - parts.left_count);
  if (shared)
    copy_parallel(scratch, split.right.refs.size(), split.right.refs.data());
  else
    std::copy_n(scratch, split.right.refs.size(), split.right.refs.data());
  split.left.box = plane.left;
  split.right.box = plane.right;
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
  return {make_ref_set(set.refs.first(middle), 0), make_ref_set(set.refs.subspan(middle), set.spare)};
}

}  // namespace sundog
