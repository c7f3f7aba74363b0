// Angle-weighted vertex normals (Thürmer and Wüthrich 1998) with creases.
// In: triangles, perhaps some normals. Out: parallel normals, vertices split along creases.
#include "scene/models/normals.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>

namespace sundog::models {
namespace {

using std::uint32_t;

// More faces than this at one edge are no surface: all its edges are creases (and comparing all pairs would
// be slow).
constexpr std::size_t most_faces_at_edge = 16;
constexpr std::size_t most_triangles = std::size_t{1} << 30;  // corners are counted in 32 bits
const glm::vec3 any_direction{0, 1, 0};

bool normalize(dvec3 sum, glm::vec3& out) {
  const double length = glm::length(sum);
  if (!(length > 0) || !std::isfinite(length)) return false;
  out = glm::vec3(sum / length);
  return true;
}

uint32_t corner_vertex(const Mesh& mesh, uint32_t corner) {
  return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

// What lies around one point: the corners that want a normal, joined into smooth fans.
class PointFans {
 public:
  PointFans(Mesh& mesh, double crease_degrees, std::vector<uint32_t> points)
      : mesh_(mesh), points_(std::move(points)), cosine_(std::cos(crease_degrees * std::numbers::pi / 180)) {
    face_normals_.resize(mesh.triangles.size());
    for (std::size_t i = 0; i < face_normals_.size(); ++i) {
      const glm::uvec3 t = mesh.triangles[i];
      const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      if (!normalize(glm::cross(b - a, c - a), face_normals_[i])) face_normals_[i] = glm::vec3(0);
    }
  }

  void finish(std::span<const uint32_t> corners) {
    join_across_edges(corners);
    sum_fans(corners);
    give_normals(corners);
  }

 private:
  struct Spoke {
    uint32_t to, corner;  // the edge's other point; a number in `corners`
  };

  uint32_t point(uint32_t vertex) const { return points_.empty() ? vertex : points_[vertex]; }
  uint32_t neighbour(uint32_t corner, uint32_t step) const {
    return corner_vertex(mesh_, corner - corner % 3 + (corner % 3 + step) % 3);
  }
  bool has_area(uint32_t corner) const { return face_normals_[corner / 3] != glm::vec3(0); }

  uint32_t root(uint32_t i) {
    while (fan_[i] != i) i = fan_[i] = fan_[fan_[i]];
    return i;
  }

  void join_if_smooth(uint32_t i, uint32_t j, std::span<const uint32_t> corners) {
    const dvec3 a = face_normals_[corners[i] / 3], b = face_normals_[corners[j] / 3];
    if (glm::dot(a, b) < cosine_ - 1e-7) return;
    const uint32_t first = root(i), second = root(j);
    fan_[std::max(first, second)] = std::min(first, second);
  }

  void join_across_edges(std::span<const uint32_t> corners) {
    fan_.resize(corners.size());
    std::iota(fan_.begin(), fan_.end(), 0u);
    spokes_.clear();
    for (uint32_t i = 0; i < corners.size(); ++i)
      if (has_area(corners[i]))
        for (const uint32_t step : {1u, 2u}) spokes_.push_back({point(neighbour(corners[i], step)), i});
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

  double angle(uint32_t corner) const {
    const dvec3 at = mesh_.positions[corner_vertex(mesh_, corner)];
    const dvec3 a = dvec3(mesh_.positions[neighbour(corner, 1)]) - at;
    const dvec3 b = dvec3(mesh_.positions[neighbour(corner, 2)]) - at;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  }

  void sum_fans(std::span<const uint32_t> corners) {
    sums_.assign(corners.size(), dvec3(0));
    for (uint32_t i = 0; i < corners.size(); ++i)
      if (has_area(corners[i])) sums_[root(i)] += angle(corners[i]) * dvec3(face_normals_[corners[i] / 3]);
  }

  // Each (vertex, fan) is one vertex of the result; the first fan keeps the vertex. Faces without area,
  // sorted last, take what the fan before them got.
  void give_normals(std::span<const uint32_t> corners) {
    claims_.clear();
    for (uint32_t i = 0; i < corners.size(); ++i)
      claims_.push_back(
          {corner_vertex(mesh_, corners[i]), has_area(corners[i]) ? root(i) : no_fan, corners[i]});
    std::sort(claims_.begin(), claims_.end());
    uint32_t result = 0;
    for (std::size_t i = 0; i < claims_.size(); ++i) {
      const Claim& claim = claims_[i];
      const bool new_vertex = i == 0 || claims_[i - 1].vertex != claim.vertex;
      if (new_vertex || (claims_[i - 1].fan != claim.fan && claim.fan != no_fan)) {
        result = new_vertex ? claim.vertex : copy(claim.vertex);
        set_normal(result, claim.fan, corners);
      }
      mesh_.triangles[claim.corner / 3][static_cast<int>(claim.corner % 3)] = result;
    }
  }

  void set_normal(uint32_t vertex, uint32_t fan, std::span<const uint32_t> corners) {
    glm::vec3& normal = mesh_.normals[vertex];
    if (fan == no_fan) {
      normal = any_direction;
    } else if (!normalize(sums_[fan], normal)) {
      normal = face_normals_[corners[fan] / 3];
    }
  }

  uint32_t copy(uint32_t vertex) {
    const auto again = [vertex](auto& values) {
      if (values.empty()) return;
      const auto value = values[vertex];
      values.push_back(value);
    };
    again(mesh_.positions);
    again(mesh_.normals);
    again(mesh_.uvs);
    for (auto& set : mesh_.further_uvs) again(set);
    again(mesh_.tangents);
    again(mesh_.colors);
    again(points_);
    return static_cast<uint32_t>(mesh_.positions.size() - 1);
  }

  static constexpr uint32_t no_fan = std::numeric_limits<uint32_t>::max();
  struct Claim {
    uint32_t vertex, fan, corner;
    auto operator<=>(const Claim&) const = default;
  };

  Mesh& mesh_;
  std::vector<uint32_t> points_;
  double cosine_;
  std::vector<glm::vec3> face_normals_;  // unit, or 0 for a face without area
  std::vector<uint32_t> fan_;            // union-find over the corners at hand
  std::vector<Spoke> spokes_;
  std::vector<dvec3> sums_;
  std::vector<Claim> claims_;
};

// The corners that want a normal, gathered by point: corners[first[p] .. first[p + 1]).
struct CornersByPoint {
  std::vector<uint32_t> first, corners;
};

CornersByPoint gather(const Mesh& mesh, const std::vector<bool>& has_normal,
                      const std::vector<uint32_t>& points) {
  const auto point = [&](uint32_t vertex) { return points.empty() ? vertex : points[vertex]; };
  CornersByPoint by_point;
  by_point.first.assign(mesh.positions.size() + 1, 0);
  const auto corner_count = static_cast<uint32_t>(mesh.triangles.size() * 3);
  for (uint32_t c = 0; c < corner_count; ++c)
    if (!has_normal[corner_vertex(mesh, c)]) ++by_point.first[point(corner_vertex(mesh, c)) + 1];
  std::partial_sum(by_point.first.begin(), by_point.first.end(), by_point.first.begin());
  by_point.corners.resize(by_point.first.back());
  std::vector<uint32_t> next(by_point.first.begin(), by_point.first.end() - 1);
  for (uint32_t c = 0; c < corner_count; ++c)
    if (!has_normal[corner_vertex(mesh, c)]) by_point.corners[next[point(corner_vertex(mesh, c))]++] = c;
  return by_point;
}

}  // namespace

void complete_normals(Mesh& mesh, std::vector<bool> has_normal, double crease_degrees,
                      std::vector<std::uint32_t> point_of_vertex) {
  if (mesh.triangles.size() > most_triangles) throw std::length_error("more than 2^30 triangles");
  if (has_normal.empty()) has_normal.assign(mesh.positions.size(), !mesh.normals.empty());
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0));
  bool any = false, all = true;
  for (std::size_t i = 0; i < has_normal.size(); ++i) {
    has_normal[i] = has_normal[i] && normalize(mesh.normals[i], mesh.normals[i]);
    any = any || has_normal[i];
    all = all && has_normal[i];
  }
  if (all) return;
  if (!any && crease_degrees <= 0) {
    mesh.normals.clear();
    return;
  }
  for (std::size_t i = 0; i < has_normal.size(); ++i)
    if (!has_normal[i]) mesh.normals[i] = any_direction;  // a vertex of no triangle keeps it
  const CornersByPoint around = gather(mesh, has_normal, point_of_vertex);
  PointFans fans(mesh, crease_degrees, std::move(point_of_vertex));
  for (std::size_t p = 0; p + 1 < around.first.size(); ++p)
    if (around.first[p] < around.first[p + 1])
      fans.finish(std::span(around.corners).subspan(around.first[p], around.first[p + 1] - around.first[p]));
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
