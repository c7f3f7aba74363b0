// The corners of a mesh, grouped by the point that they meet at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "models/values/mesh.h"

namespace sundog::models {

inline std::uint32_t corner_vertex(const Mesh& mesh, std::uint32_t corner) {
  return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

/// A large array whose pages are first touched by the threads that fill them; zeroing it takes longer than
/// using it.
template <class T>
using Filled = std::unique_ptr<T[]>;

/// The corners that need a normal, grouped by point, in order: corners[first[p] .. first[p + 1]).
struct CornersByPoint {
  std::vector<std::uint32_t> first;
  Filled<std::uint32_t> corners;

  std::size_t points() const { return first.size() - 1; }
  std::span<const std::uint32_t> around(std::size_t point) const {
    return {corners.get() + first[point], first[point + 1] - first[point]};
  }
};

/// Gathers the corners of vertices without a normal. `has_normal`: a flag per vertex; empty: no vertex has
/// one. `points`: the point of each vertex; empty: each vertex is a point.
CornersByPoint gather_corners(const Mesh& mesh, const std::vector<bool>& has_normal,
                              const std::vector<std::uint32_t>& points);

}  // namespace sundog::models
