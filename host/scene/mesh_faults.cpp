// Welds positions and counts each edge's directions; if all match, computes the signed volume of each
// connected part. Parts may face inwards within a larger one.
#include "scene/mesh_faults.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "models/normals.h"

namespace sundog {
namespace {

struct Edge {
  std::uint32_t low, high;
  int way;  // 1: from low to high, else -1
};

void count_edges(std::vector<Edge>& edges, MeshFaults& faults) {
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    int ways = 0;
    for (; end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high;
         ++end)
      ways += edges[end].way;
    if ((end - begin) % 2 == 1)
      ++faults.open_edges;
    else if (ways != 0)
      ++faults.turned_edges;
  }
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t at) {
  while (parent[at] != at) at = parent[at] = parent[parent[at]];
  return at;
}

struct Part {
  double volume = 0;
  glm::vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

  bool holds(const Part& other) const {
    return glm::all(glm::lessThanEqual(lower, other.lower)) &&
           glm::all(glm::greaterThanEqual(upper, other.upper));
  }
};

std::vector<Part> parts_of(const Mesh& mesh, std::span<const glm::uvec3> triangles) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const glm::uvec3& t : triangles) {
    parent[root_of(parent, t.y)] = root_of(parent, t.x);
    parent[root_of(parent, t.z)] = root_of(parent, t.x);
  }
  std::vector<Part> parts(mesh.positions.size());
  for (const glm::uvec3& t : triangles) {
    const std::uint32_t root = root_of(parent, t.x);
    const dvec3 origin(mesh.positions[root]);
    const auto corner = [&](std::uint32_t i) { return dvec3(mesh.positions[i]) - origin; };
    parts[root].volume += glm::dot(corner(t.x), glm::cross(corner(t.y), corner(t.z)));
    for (int k = 0; k < 3; ++k) {
      parts[root].lower = glm::min(parts[root].lower, mesh.positions[t[k]]);
      parts[root].upper = glm::max(parts[root].upper, mesh.positions[t[k]]);
    }
  }
  std::erase_if(parts, [](const Part& part) { return part.lower.x > part.upper.x; });
  return parts;
}

/// Tests for hollows only in the largest parts, because there may be very many.
std::size_t count_inside_out(std::vector<Part>& parts) {
  constexpr std::ptrdiff_t most = 100;
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.volume > b.volume; });
  const auto solid_end =
      std::find_if(parts.begin(), parts.end(), [](const Part& part) { return part.volume <= 0; });
  const auto large_end = parts.begin() + std::min(most, solid_end - parts.begin());
  return static_cast<std::size_t>(std::count_if(solid_end, parts.end(), [&](const Part& part) {
    return part.volume < 0 &&
           std::none_of(parts.begin(), large_end, [&](const Part& solid) { return solid.holds(part); });
  }));
}

}  // namespace

MeshFaults find_faults(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = models::weld_positions(mesh);
  std::vector<glm::uvec3> triangles;
  std::vector<Edge> edges;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::uvec3 corners(first[t.x], first[t.y], first[t.z]);
    if (corners.x == corners.y || corners.y == corners.z || corners.z == corners.x) continue;
    triangles.push_back(corners);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  MeshFaults faults;
  count_edges(edges, faults);
  if (faults.open_edges > 0 || faults.turned_edges > 0) return faults;
  std::vector<Part> parts = parts_of(mesh, triangles);
  faults.parts = parts.size();
  faults.inside_out = count_inside_out(parts);
  return faults;
}

}  // namespace sundog
