// Takes candidates from a grid with cells about twice as large as the triangles, and compares their planes,
// then their outlines along the main axis.
#include "compile/touching/touching_triangles.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sundog {
namespace {

struct DoubleBox {
  dvec3 lower, upper;
};

DoubleBox box_of(const PlacedTriangle& t, double tolerance) {
  return {glm::min(glm::min(t.corner[0], t.corner[1]), t.corner[2]) - tolerance,
          glm::max(glm::max(t.corner[0], t.corner[1]), t.corner[2]) + tolerance};
}

bool overlap(const DoubleBox& a, const DoubleBox& b) {
  return glm::all(glm::lessThanEqual(a.lower, b.upper)) && glm::all(glm::lessThanEqual(b.lower, a.upper));
}

using Flat = std::array<glm::dvec2, 3>;

/// Projects the triangle along axis `away`.
Flat flatten(const PlacedTriangle& t, int away) {
  const int u = (away + 1) % 3, v = (away + 2) % 3;
  Flat flat;
  for (std::size_t i = 0; i < 3; ++i) flat[i] = {t.corner[i][u], t.corner[i][v]};
  return flat;
}

/// Whether an edge of `a` separates it from `b`. A smaller overlap, relative to a triangle, is mere contact
/// along an edge.
bool parted_by_edge(const Flat& a, const Flat& b) {
  constexpr double share = 1e-4;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec2 edge = a[(i + 1) % 3] - a[i], across(-edge.y, edge.x);
    double low_a = INFINITY, high_a = -INFINITY, low_b = INFINITY, high_b = -INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at_a = glm::dot(across, a[k] - a[i]), at_b = glm::dot(across, b[k] - a[i]);
      low_a = std::min(low_a, at_a), high_a = std::max(high_a, at_a);
      low_b = std::min(low_b, at_b), high_b = std::max(high_b, at_b);
    }
    const double common = std::min(high_a, high_b) - std::max(low_a, low_b);
    if (common <= share * std::min(high_a - low_a, high_b - low_b)) return true;
  }
  return false;
}

/// A triangle's entry in a grid cell.
struct Entry {
  std::uint64_t cell;
  std::uint32_t index;
  bool second;  // the index is into the second list
};

class Grid {
 public:
  Grid(std::span<const PlacedTriangle> a, std::span<const PlacedTriangle> b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {
    double sum = 0;
    for (const auto& list : {a, b})
      for (const PlacedTriangle& t : list) {
        const DoubleBox box = box_of(t, 0);
        const dvec3 size = box.upper - box.lower;
        sum += std::max({size.x, size.y, size.z});
      }
    cell_ = std::max(2 * sum / double(a.size() + b.size()), 4 * tolerance);
    add(a, false);
    add(b, true);
    tbb::parallel_sort(entries_.begin(), entries_.end(), [](const Entry& x, const Entry& y) {
      return x.cell != y.cell ? x.cell < y.cell : x.index < y.index;
    });
  }

  bool any_pair() const {
    for (const Entry& one : large_)
      for (const auto& [list, second] : {std::pair{a_, false}, std::pair{b_, true}})
        for (std::uint32_t i = 0; i < list.size(); ++i)
          if (pair_lies(one, {0, i, second})) return true;
    for (std::size_t first = 0, last; first < entries_.size(); first = last) {
      for (last = first + 1; last < entries_.size() && entries_[last].cell == entries_[first].cell;) ++last;
      for (std::size_t i = first; i < last; ++i)
        for (std::size_t k = i + 1; k < last; ++k)
          if (pair_lies(entries_[i], entries_[k])) return true;
    }
    return false;
  }

 private:
  void add(std::span<const PlacedTriangle> list, bool second) {
    constexpr double most_cells = 512;
    for (std::uint32_t i = 0; i < list.size(); ++i) {
      const DoubleBox box = box_of(list[i], tolerance_);
      const dvec3 from = glm::floor(box.lower / cell_), to = glm::floor(box.upper / cell_),
                  n = to - from + 1.0;
      if (n.x * n.y * n.z > most_cells) {
        large_.push_back({0, i, second});
        continue;
      }
      for (double x = from.x; x <= to.x; ++x)
        for (double y = from.y; y <= to.y; ++y)
          for (double z = from.z; z <= to.z; ++z) entries_.push_back({key(x, y, z), i, second});
    }
  }

  /// Cells that share a key only cost comparisons.
  static std::uint64_t key(double x, double y, double z) {
    const auto part = [](double value) { return std::uint64_t(std::int64_t(value)) & 0x1FFFFF; };
    return part(x) << 42 | part(y) << 21 | part(z);
  }

  bool pair_lies(const Entry& x, const Entry& y) const {
    if (x.second == y.second && (!b_.empty() || x.index == y.index)) return false;
    const PlacedTriangle &s = (x.second ? b_ : a_)[x.index], &t = (y.second ? b_ : a_)[y.index];
    return overlap(box_of(s, tolerance_), box_of(t, tolerance_)) && lies_on(s, t, tolerance_);
  }

  std::span<const PlacedTriangle> a_, b_;
  double tolerance_, cell_ = 1;
  std::vector<Entry> entries_, large_;
};

}  // namespace

bool lies_on(const PlacedTriangle& a, const PlacedTriangle& b, double tolerance) {
  constexpr double aslant = 2e-3;  // more than rounding tilts a small triangle
  const dvec3 normal_a = glm::cross(a.corner[1] - a.corner[0], a.corner[2] - a.corner[0]),
              normal_b = glm::cross(b.corner[1] - b.corner[0], b.corner[2] - b.corner[0]);
  const double size_a = glm::length(normal_a), size_b = glm::length(normal_b);
  if (!(size_a > 0) || !(size_b > 0)) return false;
  if (glm::length(glm::cross(normal_a, normal_b)) > aslant * size_a * size_b) return false;
  double low = INFINITY, high = -INFINITY;
  for (const dvec3& corner : b.corner) {
    const double height = glm::dot(normal_a, corner - a.corner[0]) / size_a;
    low = std::min(low, height), high = std::max(high, height);
  }
  if (low > tolerance || high < -tolerance) return false;
  const dvec3 size = glm::abs(normal_a);
  const int away = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const Flat flat_a = flatten(a, away), flat_b = flatten(b, away);
  return !parted_by_edge(flat_a, flat_b) && !parted_by_edge(flat_b, flat_a);
}

bool any_lies_on(std::span<const PlacedTriangle> a, std::span<const PlacedTriangle> b, double tolerance) {
  return !a.empty() && Grid(a, b, tolerance).any_pair();
}

}  // namespace sundog
