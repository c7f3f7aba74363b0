// Planes that split triangles: boxes are clipped at bin borders, and a triangle that straddles the chosen
// plane goes to both sides, or whole to one if that is cheaper. See split.h.
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compile/bvh/split.h"

namespace sundog {
namespace {

constexpr int space_bins = 16;

Bounds overlap(const Bounds& a, const Bounds& b) {
  return {lanes_max(a.lower, b.lower), lanes_min(a.upper, b.upper)};
}

Bounds joint(Bounds a, const Bounds& b) {
  a.extend(b);
  return a;
}

bool is_empty(const Bounds& box) {
  return !(box.lower[0] <= box.upper[0] && box.lower[1] <= box.upper[1] && box.lower[2] <= box.upper[2]);
}

/// Planes between equal slices of a box.
struct Slices {
  Lanes base, scale, width;

  explicit Slices(const Bounds& box)
      : base(box.lower), width((box.upper - box.lower) * lanes(1.0f / space_bins)) {
    for (int axis = 0; axis < 3; ++axis) scale[axis] = width[axis] > least_extent ? 1 / width[axis] : 0.0f;
    scale[3] = 0;
  }
  bool usable(int axis) const { return scale[axis] > 0; }
  int slice(float x, int axis) const {
    return std::clamp(static_cast<int>((x - base[axis]) * scale[axis]), 0, space_bins - 1);
  }
  /// Position of the lower plane of slice `i`.
  float begin(int i, int axis) const { return base[axis] + static_cast<float>(i) * width[axis]; }
};

struct Halves {
  Bounds left = Bounds::none(), right = Bounds::none();
};

/// Adds the intersection of an edge with the plane, rounded outwards.
void add_crossing(Halves& halves, const glm::vec3& a, const glm::vec3& b, int axis, float position) {
  const double t = (double(position) - double(a[axis])) / (double(b[axis]) - double(a[axis]));
  Bounds point{lanes(0), lanes(0)};
  for (int i = 0; i < 3; ++i) {
    const auto p = static_cast<float>(double(a[i]) + t * (double(b[i]) - double(a[i])));
    point.lower[i] = i == axis ? position : std::nextafter(p, -std::numeric_limits<float>::infinity());
    point.upper[i] = i == axis ? position : std::nextafter(p, std::numeric_limits<float>::infinity());
  }
  halves.left.extend(point);
  halves.right.extend(point);
}

/// Boxes around the triangle's parts on both sides of a plane; may be empty.
Halves cut(const Mesh& mesh, u32 prim, const Bounds& box, int axis, float position) {
  const glm::uvec3& triangle = mesh.triangles[prim];
  Halves halves;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 &a = mesh.positions[triangle[i]], &b = mesh.positions[triangle[(i + 1) % 3]];
    const Lanes corner{a.x, a.y, a.z, 0};
    if (a[axis] <= position) halves.left.extend(corner);
    if (a[axis] >= position) halves.right.extend(corner);
    if ((a[axis] < position && position < b[axis]) || (b[axis] < position && position < a[axis]))
      add_crossing(halves, a, b, axis, position);
  }
  return {overlap(halves.left, box), overlap(halves.right, box)};
}

struct SpaceBins {
  std::array<std::array<Bounds, space_bins>, 3> box;
  std::array<std::array<u32, space_bins>, 3> begins{}, ends{};  // refs by first and by last slice

  SpaceBins() {
    for (auto& axis : box) axis.fill(Bounds::none());
  }
  void add(const Ref& ref, const Slices& slices, const Mesh& mesh) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!slices.usable(axis)) continue;
      const auto a = static_cast<std::size_t>(axis);
      const int first = slices.slice(ref.box.lower[axis], axis),
                last = slices.slice(ref.box.upper[axis], axis);
      ++begins[a][static_cast<std::size_t>(first)];
      ++ends[a][static_cast<std::size_t>(last)];
      Bounds rest = ref.box;
      for (int i = first; i < last; ++i) {
        const Halves halves = cut(mesh, ref.prim(), rest, axis, slices.begin(i + 1, axis));
        if (!is_empty(halves.left)) box[a][static_cast<std::size_t>(i)].extend(halves.left);
        rest = halves.right;
      }
      if (!is_empty(rest)) box[a][static_cast<std::size_t>(last)].extend(rest);
    }
  }
  void add(const SpaceBins& other) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < space_bins; ++i) {
        box[axis][i].extend(other.box[axis][i]);
        begins[axis][i] += other.begins[axis][i];
        ends[axis][i] += other.ends[axis][i];
      }
  }
};

SpaceBins fill_bins(const RefSet& set, const Slices& slices, const SplitSettings& settings) {
  const auto add = [&](SpaceBins sum, std::span<const Ref> refs) {
    for (const Ref& ref : refs) sum.add(ref, slices, *settings.mesh);
    return sum;
  };
  if (!share_work(set.refs.size(), settings)) return add(SpaceBins{}, set.refs);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, set.refs.size(), split_chunk), SpaceBins{},
      [&](const auto& range, const SpaceBins& sum) {
        return add(sum, set.refs.subspan(range.begin(), range.size()));
      },
      [](SpaceBins a, const SpaceBins& b) {
        a.add(b);
        return a;
      });
}

/// A plane before slice `slice`, and the resulting parts.
struct SpacePlane {
  int axis = -1, slice = 0;
  float cost = 0;
  Bounds left, right;
  std::size_t left_count = 0, right_count = 0;
};

/// Finds the cheapest plane of one axis that is below `plane.cost` and whose parts have room.
void search_axis(const SpaceBins& bins, int axis, const RefSet& set, const SplitSettings& settings,
                 SpacePlane& plane) {
  const auto a = static_cast<std::size_t>(axis);
  std::array<Bounds, space_bins> right;
  std::array<std::size_t, space_bins> right_count{};
  Bounds sum = Bounds::none();
  std::size_t n = 0;
  for (std::size_t i = space_bins; i-- > 0;) {
    sum.extend(bins.box[a][i]);
    right[i] = sum;
    right_count[i] = n += bins.ends[a][i];
  }
  sum = Bounds::none();
  n = 0;
  const std::size_t count = set.refs.size(), room = count + set.spare;
  for (std::size_t i = 1; i < space_bins; ++i) {
    sum.extend(bins.box[a][i - 1]);
    n += bins.begins[a][i - 1];
    if (n == 0 || right_count[i] == 0 || n >= count || right_count[i] >= count || n + right_count[i] > room)
      continue;
    if (is_empty(sum) || is_empty(right[i])) continue;
    const float cost = half_area(sum, settings.area_scale) * blocks(n, settings) +
                       half_area(right[i], settings.area_scale) * blocks(right_count[i], settings);
    if (cost < plane.cost) plane = {axis, static_cast<int>(i), cost, sum, right[i], n, right_count[i]};
  }
}

enum class Way { left, right, both };

/// The cheapest side for a straddling ref (section 4.4 of the paper). Counts members, because blocks would
/// hide a single one.
Way cheapest_way(const SpacePlane& plane, const Ref& ref, float scale) {
  const float left = half_area(plane.left, scale), right = half_area(plane.right, scale);
  const auto n = static_cast<float>(plane.left_count), m = static_cast<float>(plane.right_count);
  const float both = left * n + right * m;
  const float only_left = half_area(joint(plane.left, ref.box), scale) * n + right * (m - 1);
  const float only_right = left * (n - 1) + half_area(joint(plane.right, ref.box), scale) * m;
  if (only_left < both && only_left <= only_right) return Way::left;
  return only_right < both ? Way::right : Way::both;
}

class Partition {
 public:
  Partition(const RefSet& set, const SplitSettings& settings, const Slices& slices, const SpacePlane& plane)
      : settings_(settings),
        plane_(plane),
        position_(slices.begin(plane.slice, plane.axis)),
        left_to_(set.refs.data()),
        right_to_(settings.scratch + (set.refs.data() - settings.all.data())) {
    // Left refs overwrite the set from its front; there are never more than have been read.
    const Ref* const right_begin = right_to_;
    for (const Ref ref : set.refs) add(ref, slices);
    const auto left_count = static_cast<std::size_t>(left_to_ - set.refs.data());
    const auto right_count = static_cast<std::size_t>(right_to_ - right_begin);
    split_ = place_parts(set, left_count, right_count);
    std::copy_n(right_begin, right_count, split_.right.refs.data());
    for (int side = 0; side < 2; ++side) {
      RefSet& part = side == 0 ? split_.left : split_.right;
      part.box = sides_[side].box;
      part.centers = sides_[side].centers;
    }
  }
  const RefSplit& split() const { return split_; }

 private:
  void add(const Ref& ref, const Slices& slices) {
    if (slices.slice(ref.box.upper[plane_.axis], plane_.axis) < plane_.slice) return put_left(ref, ref.box);
    if (slices.slice(ref.box.lower[plane_.axis], plane_.axis) >= plane_.slice) return put_right(ref, ref.box);
    const Way way = cheapest_way(plane_, ref, settings_.area_scale);
    const Halves halves = cut(*settings_.mesh, ref.prim(), ref.box, plane_.axis, position_);
    const bool has_left = !is_empty(halves.left), has_right = !is_empty(halves.right);
    if (way == Way::left || (way == Way::both && !has_right)) return put_left(ref, ref.box);
    if (way == Way::right || !has_left) return put_right(ref, ref.box);
    put_left(ref, halves.left);
    put_right(ref, halves.right);
  }
  void put_left(const Ref& ref, const Bounds& box) { put(ref, box, 0, left_to_); }
  void put_right(const Ref& ref, const Bounds& box) { put(ref, box, 1, right_to_); }
  void put(const Ref& ref, const Bounds& box, std::size_t side, Ref*& to) {
    *to = Ref::of(box, ref.prim());
    sides_[side].box.extend(to->box);
    sides_[side].centers.extend(to->center2());
    ++to;
  }

  const SplitSettings& settings_;
  const SpacePlane& plane_;
  float position_;
  Ref *left_to_, *right_to_;
  struct {
    Bounds box = Bounds::none(), centers = Bounds::none();
  } sides_[2];
  RefSplit split_;
};

}  // namespace

std::optional<RefSplit> split_in_space(const RefSet& set, const SplitSettings& settings, float least) {
  if (set.spare == 0) return std::nullopt;
  const Slices slices(set.box);
  const SpaceBins bins = fill_bins(set, slices, settings);
  SpacePlane plane;
  plane.cost = least;
  for (int axis = 0; axis < 3; ++axis)
    if (slices.usable(axis)) search_axis(bins, axis, set, settings, plane);
  if (plane.axis < 0) return std::nullopt;
  return Partition(set, settings, slices, plane).split();
}

}  // namespace sundog
