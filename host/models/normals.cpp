// Computes angle-weighted vertex normals (Thürmer and Wüthrich 1998) in parallel, and splits vertices along
// creases.
#include "models/normals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "models/angles.h"
#include "models/corners.h"

namespace sundog::models {
namespace {

using std::uint32_t;

// An edge with more faces than this is treated as a crease (comparing all pairs would be slow).
constexpr std::size_t most_faces_at_edge = 16;
constexpr std::size_t most_triangles = std::size_t{1} << 30;  // corners are counted in 32 bits
const glm::vec3 any_direction{0, 1, 0};

bool normalize(glm::dvec3 sum, glm::vec3& out) {
  const double length = glm::length(sum);
  if (!(length > 0) || !std::isfinite(length)) return false;
  out = glm::vec3(sum / length);
  return true;
}

/// Unit length, or 0 for a degenerate face.
Filled<glm::vec3> face_normals(const Mesh& mesh) {
  auto normals = std::make_unique_for_overwrite<glm::vec3[]>(mesh.triangles.size());
  in_parallel(mesh.triangles.size(), [&](std::size_t i) {
    const glm::uvec3 t = mesh.triangles[i];
    const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    if (!normalize(glm::cross(b - a, c - a), normals[i])) normals[i] = glm::vec3(0);
  });
  return normals;
}

/// Inputs shared by all points.
struct Surroundings {
  const Mesh& mesh;
  const std::vector<uint32_t>& points;  // of vertices; empty: each vertex is a point
  const std::vector<uint32_t>& groups;  // of faces; empty: the crease decides
  double cosine;                        // of the crease angle
  Filled<glm::vec3> face_normals;

  uint32_t point(uint32_t vertex) const { return points.empty() ? vertex : points[vertex]; }
  uint32_t neighbour(uint32_t corner, uint32_t step) const {
    return corner_vertex(mesh, corner - corner % 3 + (corner % 3 + step) % 3);
  }
  bool is_smooth(uint32_t face, uint32_t other) const {
    if (!groups.empty()) return groups[face] != 0 && groups[face] == groups[other];
    return glm::dot(glm::dvec3(face_normals[face]), glm::dvec3(face_normals[other])) >= cosine - 1e-7;
  }
  bool has_area(uint32_t corner) const { return face_normals[corner / 3] != glm::vec3(0); }
};

/// A vertex of the result. A vertex's first fan keeps it; each further one gets a copy.
struct FanVertex {
  uint32_t vertex;
  bool copied;
  glm::vec3 normal;
};

/// The corners around one point, grouped into smooth fans.
class PointFans {
 public:
  explicit PointFans(const Surroundings& shared) : shared_(shared) {}

  /// Appends the vertices around a point to `vertices`, and sets each corner's vertex.
  void add(std::span<const uint32_t> corners, std::vector<FanVertex>& vertices, uint32_t* vertex_of) {
    join_across_edges(corners);
    sum_fans(corners);
    claim_vertices(corners, vertices, vertex_of);
  }

 private:
  struct Spoke {
    uint32_t to, corner;  // the edge's other point; an index into `corners`
  };

  uint32_t root(uint32_t i) {
    while (fan_[i] != i) i = fan_[i] = fan_[fan_[i]];
    return i;
  }

  void join_if_smooth(uint32_t i, uint32_t j, std::span<const uint32_t> corners) {
    if (!shared_.is_smooth(corners[i] / 3, corners[j] / 3)) return;
    const uint32_t first = root(i), second = root(j);
    fan_[std::max(first, second)] = std::min(first, second);
  }

  // join_across_edges() for few corners, where comparing pairs beats sorting.
  void join_pairs(std::span<const uint32_t> corners) {
    for (uint32_t i = 0; i < corners.size(); ++i)
      for (const uint32_t step : {1u, 2u})
        ends_[i][step - 1] = shared_.point(shared_.neighbour(corners[i], step));
    if (is_smooth_ring(corners)) {
      std::fill(fan_.begin(), fan_.end(), 0u);
      return;
    }
    for (uint32_t i = 0; i < corners.size(); ++i) {
      if (!shared_.has_area(corners[i])) continue;
      const auto [a, b] = ends_[i];
      for (uint32_t j = 0; j < i; ++j) {
        const auto [c, d] = ends_[j];
        if ((a == c || a == d || b == c || b == d) && shared_.has_area(corners[j]))
          join_if_smooth(j, i, corners);
      }
    }
  }

  // The common case: each corner's second edge is the next one's first, all around, and the surface
  // is smooth there.
  bool is_smooth_ring(std::span<const uint32_t> corners) const {
    const auto count = static_cast<uint32_t>(corners.size());
    uint32_t at = 0, met = 0;
    for (; met < count; ++met) {
      if (!shared_.has_area(corners[at])) return false;
      uint32_t next = 0;
      while (next < count && ends_[next][0] != ends_[at][1]) ++next;
      if (next == count || !shared_.is_smooth(corners[at] / 3, corners[next] / 3)) return false;
      at = next;
      if (at == 0) break;
    }
    return met + 1 == count;
  }

  void join_across_edges(std::span<const uint32_t> corners) {
    fan_.resize(corners.size());
    std::iota(fan_.begin(), fan_.end(), 0u);
    if (corners.size() <= most_faces_at_edge) return join_pairs(corners);
    spokes_.clear();
    for (uint32_t i = 0; i < corners.size(); ++i)
      if (shared_.has_area(corners[i]))
        for (const uint32_t step : {1u, 2u})
          spokes_.push_back({shared_.point(shared_.neighbour(corners[i], step)), i});
    std::sort(spokes_.begin(), spokes_.end(),
              [](Spoke a, Spoke b) { return a.to != b.to ? a.to < b.to : a.corner < b.corner; });
    for (std::size_t begin = 0, end = 0; begin < spokes_.size(); begin = end) {
      while (end < spokes_.size() && spokes_[end].to == spokes_[begin].to) ++end;
      if (end - begin > most_faces_at_edge) continue;
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t j = i + 1; j < end; ++j)
          join_if_smooth(spokes_[i].corner, spokes_[j].corner, corners);
    }
  }

  // Sets the angle of each corner, in radians.
  void measure_angles(std::span<const uint32_t> corners) {
    sines_.resize(corners.size());
    cosines_.resize(corners.size());
    angles_.resize(corners.size());
    const auto position = [&](uint32_t vertex) { return glm::dvec3(shared_.mesh.positions[vertex]); };
    for (uint32_t i = 0; i < corners.size(); ++i) {
      const glm::dvec3 at = position(corner_vertex(shared_.mesh, corners[i]));
      const glm::dvec3 a = position(shared_.neighbour(corners[i], 1)) - at;
      const glm::dvec3 b = position(shared_.neighbour(corners[i], 2)) - at;
      sines_[i] = glm::length(glm::cross(a, b));
      cosines_[i] = glm::dot(a, b);
    }
    angles_of(sines_, cosines_, angles_);
  }

  void sum_fans(std::span<const uint32_t> corners) {
    measure_angles(corners);
    sums_.assign(corners.size(), glm::dvec3(0));
    for (uint32_t i = 0; i < corners.size(); ++i)
      if (shared_.has_area(corners[i]))
        sums_[root(i)] += angles_[i] * glm::dvec3(shared_.face_normals[corners[i] / 3]);
  }

  // The common case: one vertex and one fan.
  bool is_one_fan(std::span<const uint32_t> corners) {
    for (uint32_t i = 0; i < corners.size(); ++i)
      if (corner_vertex(shared_.mesh, corners[i]) != corner_vertex(shared_.mesh, corners[0]) ||
          !shared_.has_area(corners[i]) || root(i) != 0)
        return false;
    return !corners.empty();
  }

  // Each (vertex, fan) becomes a vertex of the result. Degenerate faces, sorted last, join the fan before
  // them.
  void claim_vertices(std::span<const uint32_t> corners, std::vector<FanVertex>& vertices,
                      uint32_t* vertex_of) {
    if (is_one_fan(corners)) {
      std::fill_n(vertex_of, corners.size(), static_cast<uint32_t>(vertices.size()));
      vertices.push_back({corner_vertex(shared_.mesh, corners[0]), false, normal_of(0, corners)});
      return;
    }
    claims_.clear();
    for (uint32_t i = 0; i < corners.size(); ++i)
      claims_.push_back(
          {corner_vertex(shared_.mesh, corners[i]), shared_.has_area(corners[i]) ? root(i) : no_fan, i});
    std::sort(claims_.begin(), claims_.end());
    for (std::size_t i = 0; i < claims_.size(); ++i) {
      const Claim& claim = claims_[i];
      const bool new_vertex = i == 0 || claims_[i - 1].vertex != claim.vertex;
      if (new_vertex || (claims_[i - 1].fan != claim.fan && claim.fan != no_fan))
        vertices.push_back({claim.vertex, !new_vertex, normal_of(claim.fan, corners)});
      vertex_of[claim.corner] = static_cast<uint32_t>(vertices.size() - 1);
    }
  }

  glm::vec3 normal_of(uint32_t fan, std::span<const uint32_t> corners) const {
    glm::vec3 normal = any_direction;
    if (fan != no_fan && !normalize(sums_[fan], normal)) normal = shared_.face_normals[corners[fan] / 3];
    return normal;
  }

  static constexpr uint32_t no_fan = std::numeric_limits<uint32_t>::max();
  struct Claim {
    uint32_t vertex, fan, corner;  // an index into `corners`
    auto operator<=>(const Claim&) const = default;
  };

  const Surroundings& shared_;
  std::vector<uint32_t> fan_;                                     // union-find over the current corners
  std::array<std::array<uint32_t, 2>, most_faces_at_edge> ends_;  // the other points of few corners' edges
  std::vector<Spoke> spokes_;
  std::vector<double> sines_, cosines_, angles_;  // of the current corners
  std::vector<glm::dvec3> sums_;
  std::vector<Claim> claims_;
};

/// The points [first, last), whose corners are contiguous.
struct Block {
  std::size_t first, last;
  std::vector<FanVertex> vertices;
  std::size_t copies = 0;
};

std::vector<Block> make_blocks(std::size_t points) {
  constexpr std::size_t size = 8192;
  std::vector<Block> blocks;
  for (std::size_t first = 0; first < points; first += size)
    blocks.push_back({first, std::min(first + size, points), {}});
  return blocks;
}

void append_copies(Mesh& mesh, const std::vector<Block>& blocks) {
  const auto again = [&](auto& values) {
    if (values.empty()) return;
    for (const Block& block : blocks)
      for (const FanVertex& v : block.vertices)
        if (v.copied) {
          const auto value = values[v.vertex];
          values.push_back(value);
        }
  };
  again(mesh.positions);
  again(mesh.normals);
  again(mesh.uvs);
  for (auto& set : mesh.further_uvs) again(set);
  again(mesh.tangents);
  again(mesh.colors);
  again(mesh.alphas);
}

/// Stores a block's vertices, normals and corners; copies start at `next_copy`.
void place_block(std::span<glm::vec3> normals, std::span<glm::uvec3> triangles, const Block& block,
                 const CornersByPoint& around, const Filled<uint32_t>& vertex_of, std::size_t next_copy) {
  std::vector<uint32_t> place;
  place.reserve(block.vertices.size());
  for (const FanVertex& v : block.vertices) {
    place.push_back(v.copied ? static_cast<uint32_t>(next_copy++) : v.vertex);
    normals[place.back()] = v.normal;
  }
  for (std::size_t i = around.first[block.first]; i < around.first[block.last]; ++i) {
    const uint32_t corner = around.corners[i];
    triangles[corner / 3][static_cast<int>(corner % 3)] = place[vertex_of[i]];
  }
}

void give_normals(Mesh& mesh, const CornersByPoint& around, double crease_degrees,
                  const std::vector<uint32_t>& points, const std::vector<uint32_t>& groups) {
  // For each corner, its vertex in the block.
  const auto vertex_of = std::make_unique_for_overwrite<uint32_t[]>(around.first.back());
  std::vector<Block> blocks = make_blocks(around.points());
  {
    const Surroundings shared{mesh, points, groups, std::cos(crease_degrees * std::numbers::pi / 180),
                              face_normals(mesh)};
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
      Block& block = blocks[b];
      PointFans fans(shared);
      for (std::size_t p = block.first; p < block.last; ++p)
        fans.add(around.around(p), block.vertices, vertex_of.get() + around.first[p]);
      block.copies = static_cast<std::size_t>(std::ranges::count(block.vertices, true, &FanVertex::copied));
    });
  }
  std::vector<std::size_t> next_copy;
  std::size_t next = mesh.positions.size();
  for (const Block& block : blocks) next_copy.push_back(std::exchange(next, next + block.copies));
  append_copies(mesh, blocks);
  const std::span normals(mesh.normals.values());
  const std::span triangles(mesh.triangles.values());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    place_block(normals, triangles, blocks[b], around, vertex_of, next_copy[b]);
  });
}

}  // namespace

void complete_normals(Mesh& mesh, std::vector<bool> has_normal, double crease_degrees,
                      const std::vector<std::uint32_t>& point_of_vertex,
                      const std::vector<std::uint32_t>& groups) {
  if (mesh.triangles.size() > most_triangles) throw std::length_error("more than 2^30 triangles");
  if (has_normal.empty()) has_normal.assign(mesh.normals.size(), true);  // none, or one per vertex
  std::vector<glm::vec3>& normals = mesh.normals.values();
  // A vertex without a triangle keeps this.
  normals.resize(mesh.positions.size(), has_normal.empty() ? any_direction : glm::vec3(0));
  bool any = false, all = !has_normal.empty();
  for (std::size_t i = 0; i < has_normal.size(); ++i) {
    has_normal[i] = has_normal[i] && normalize(normals[i], normals[i]);
    if (!has_normal[i]) normals[i] = any_direction;
    any = any || has_normal[i];
    all = all && has_normal[i];
  }
  if (all) return;
  if (!any && crease_degrees <= 0) {
    mesh.normals.clear();
    return;
  }
  give_normals(mesh, gather_corners(mesh, has_normal, point_of_vertex), crease_degrees, point_of_vertex,
               groups);
}

std::vector<std::uint32_t> weld_positions(const Mesh& mesh) {
  std::vector<uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](uint32_t a, uint32_t b) {
    const glm::vec3 p = mesh.positions[a], q = mesh.positions[b];
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    if (p.z != q.z) return p.z < q.z;
    return a < b;
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<uint32_t> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] =
        i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

}  // namespace sundog::models
