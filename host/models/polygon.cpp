// Triangulates polygons: as a fan if possible, else by ear clipping (G. H. Meisters, "Polygons have ears",
// 1975), which is quadratic because clipping an ear affects only its two neighbours.
#include "models/polygon.h"

#include <algorithm>
#include <limits>

namespace sundog::models {
namespace {

using glm::dvec2;
using glm::dvec3;

double cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

// Twice the area as a vector (Newell). Seen from its tip, the polygon is counterclockwise.
dvec3 area_vector(std::span<const glm::vec3> corners) {
  const dvec3 origin = corners[0];
  dvec3 sum{0};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(dvec3(corners[i]) - origin, dvec3(corners[i + 1]) - origin);
  return sum;
}

// Projects the polygon by dropping the axis closest to its normal.
std::vector<dvec2> flatten(std::span<const glm::vec3> corners, dvec3 normal) {
  const dvec3 size = glm::abs(normal);
  int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int first = (dropped + 1) % 3, second = (dropped + 2) % 3;
  const bool turned = normal[dropped] < 0;
  std::vector<dvec2> points;
  points.reserve(corners.size());
  for (const glm::vec3& corner : corners)
    points.emplace_back(turned ? corner[second] : corner[first], turned ? corner[first] : corner[second]);
  return points;
}

// Twice the area of the fan's smallest triangle. Above 0, the fan covers the polygon once; at 0 too, but with
// degenerate triangles.
double least_in_fan(const std::vector<dvec2>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    least = std::min(least, cross(points[i] - points[0], points[i + 1] - points[0]));
  return least;
}

class EarClipper {
 public:
  explicit EarClipper(const std::vector<dvec2>& points) : points_(points), ring_(points.size()) {
    const auto n = static_cast<unsigned>(points.size());
    for (unsigned i = 0; i < n; ++i) ring_[i] = {.before = (i + n - 1) % n, .after = (i + 1) % n};
    for (unsigned i = 0; i < n; ++i) ring_[i].reflex = turn(i) <= 0;
    for (unsigned i = 0; i < n; ++i)
      if (ring_[i].reflex) reflex_.push_back(i);
    for (unsigned i = 0; i < n; ++i) ring_[i].ear = is_ear(i);
  }

  void run(std::vector<glm::uvec3>& triangles) {
    unsigned at = 0;
    for (std::size_t left = points_.size(); left > 3; --left) {
      at = next_ear(at, left);
      const auto [before, after, ear, reflex] = ring_[at];
      triangles.emplace_back(before, at, after);
      ring_[before].after = after;
      ring_[after].before = before;
      ring_[at].reflex = false;
      update(before);
      update(after);
      at = after;
    }
    triangles.emplace_back(ring_[at].before, at, ring_[at].after);
  }

 private:
  struct Corner {
    unsigned before, after;
    bool ear = false, reflex = false;
  };

  double turn(unsigned i) const {
    return cross(points_[i] - points_[ring_[i].before], points_[ring_[i].after] - points_[i]);
  }

  // Convex, and its triangle contains no reflex corner.
  bool is_ear(unsigned i) const {
    if (ring_[i].reflex) return false;
    const dvec2 a = points_[ring_[i].before], b = points_[i], c = points_[ring_[i].after];
    for (const unsigned r : reflex_) {
      const dvec2 p = points_[r];
      if (!ring_[r].reflex || p == a || p == b || p == c) continue;
      if (cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0) return false;
    }
    return true;
  }

  void update(unsigned i) {
    ring_[i].reflex = ring_[i].reflex && turn(i) <= 0;
    ring_[i].ear = is_ear(i);
  }

  // The next ear from `at` on; a ring without one crosses itself, so any convex corner is clipped.
  unsigned next_ear(unsigned at, std::size_t left) const {
    unsigned i = at, convex = at;
    for (std::size_t step = 0; step < left; ++step, i = ring_[i].after) {
      if (ring_[i].ear) return i;
      if (!ring_[i].reflex && ring_[convex].reflex) convex = i;
    }
    return convex;
  }

  const std::vector<dvec2>& points_;
  std::vector<Corner> ring_;
  std::vector<unsigned> reflex_;
};

void fan(std::size_t corners, std::vector<glm::uvec3>& triangles) {
  for (unsigned i = 1; i + 1 < corners; ++i) triangles.emplace_back(0u, i, i + 1);
}

}  // namespace

bool triangulate(std::span<const glm::vec3> corners, std::vector<glm::uvec3>& triangles) {
  if (corners.size() < 3) return false;
  if (corners.size() == 3) {
    triangles.emplace_back(0u, 1u, 2u);
    return true;
  }
  const dvec3 normal = area_vector(corners);
  if (normal == dvec3(0)) {
    fan(corners.size(), triangles);
    return true;
  }
  const std::vector<dvec2> points = flatten(corners, normal);
  const double least = least_in_fan(points);
  const bool too_many = corners.size() > most_concave_corners;
  if (least > 0 || (least == 0 && too_many)) {
    fan(corners.size(), triangles);
    return true;
  }
  if (too_many) return false;
  EarClipper(points).run(triangles);
  return true;
}

}  // namespace sundog::models
