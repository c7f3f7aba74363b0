// Counts and places corners in parallel by atomic additions, then sorts the corners of each point.
#include "models/corners.h"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace sundog::models {

using std::uint32_t;

CornersByPoint gather_corners(const Mesh& mesh, const std::vector<bool>& has_normal,
                              const std::vector<uint32_t>& points) {
  const std::size_t corner_count = mesh.triangles.size() * 3;
  const auto of_wanting = [&](std::size_t corner, const auto& use) {
    const uint32_t vertex = corner_vertex(mesh, static_cast<uint32_t>(corner));
    if (has_normal.empty() || !has_normal[vertex]) use(points.empty() ? vertex : points[vertex]);
  };
  CornersByPoint by_point;
  std::vector<uint32_t>& first = by_point.first;
  first.assign(mesh.positions.size() + 1, 0);
  in_parallel(corner_count, [&](std::size_t c) {
    of_wanting(
        c, [&](uint32_t point) { std::atomic_ref(first[point]).fetch_add(1, std::memory_order_relaxed); });
  });
  std::exclusive_scan(first.begin(), first.end(), first.begin(), 0u);
  by_point.corners = std::make_unique_for_overwrite<uint32_t[]>(first.back());
  // Each start advances to its end, which is the next start.
  in_parallel(corner_count, [&](std::size_t c) {
    of_wanting(c, [&](uint32_t point) {
      by_point.corners[std::atomic_ref(first[point]).fetch_add(1, std::memory_order_relaxed)] =
          static_cast<uint32_t>(c);
    });
  });
  std::shift_right(first.begin(), first.end(), 1);
  first[0] = 0;
  in_parallel(by_point.points(), [&](std::size_t p) {
    std::sort(by_point.corners.get() + first[p], by_point.corners.get() + first[p + 1]);
  });
  return by_point;
}

}  // namespace sundog::models
