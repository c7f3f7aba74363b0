// Tangents for normal maps as bakers compute them (Mikkelsen 2008, "Simulation of Wrinkled Surfaces
// Revisited", and the conventions of MikkTSpace): at each corner the mean of the tangents of the triangles
// that share its position, normal, coordinates and handedness, each projected to the normal's plane and
// weighted by its angle there. Works per triangle corner, without an index list.
#include "compile/bvh/tangents.h"

#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace sundog {
namespace {

/// Properties that corners with a common tangent share.
struct CornerKey {
  std::array<float, 8> values;  // position, normal, u and v
  bool mirrored;
  bool operator==(const CornerKey&) const = default;
};

struct CornerHash {
  std::size_t operator()(const CornerKey& key) const {
    std::size_t hash = key.mirrored;
    for (const float value : key.values)
      hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15u ^ hash >> 29;
    return hash;
  }
};

/// Directions of increasing u and v on a triangle, normalised for u; zero if the coordinates are degenerate.
struct FaceTangent {
  dvec3 tangent{0}, bitangent{0}, normal{0};
  /// Whether the frame with this normal must be mirrored for v to increase along its bitangent.
  bool mirrored(const dvec3& n) const { return glm::dot(glm::cross(n, tangent), bitangent) < 0; }
};

FaceTangent face_tangent(const Mesh& mesh, const glm::uvec3& triangle) {
  const dvec3 p0(mesh.positions[triangle.x]);
  const dvec3 e1 = dvec3(mesh.positions[triangle.y]) - p0, e2 = dvec3(mesh.positions[triangle.z]) - p0;
  const glm::dvec2 uv0(mesh.uvs[triangle.x]);
  const glm::dvec2 d1 = glm::dvec2(mesh.uvs[triangle.y]) - uv0, d2 = glm::dvec2(mesh.uvs[triangle.z]) - uv0;
  const double area = d1.x * d2.y - d2.x * d1.y, sign = area < 0 ? -1 : 1;
  const dvec3 tangent = (e1 * d2.y - e2 * d1.y) * sign, bitangent = (e2 * d1.x - e1 * d2.x) * sign;
  const double length = glm::length(tangent);
  if (area == 0 || !(length > 0) || !std::isfinite(length)) return {};
  return {tangent / length, bitangent, glm::cross(e1, e2)};
}

dvec3 unit_or_zero(const dvec3& v) {
  const double length = glm::length(v);
  return length > 1e-12 && std::isfinite(length) ? v / length : dvec3(0);
}

double angle_at(const Mesh& mesh, const glm::uvec3& triangle, int corner) {
  const dvec3 p(mesh.positions[triangle[corner]]);
  const dvec3 a = unit_or_zero(dvec3(mesh.positions[triangle[(corner + 1) % 3]]) - p),
              b = unit_or_zero(dvec3(mesh.positions[triangle[(corner + 2) % 3]]) - p);
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

/// Octahedral encoding (Meyer and others 2010): 16 and 15 bits, and the frame's sign on top.
u32 pack_tangent(const dvec3& tangent, bool mirrored) {
  const dvec3 t = tangent / (std::abs(tangent.x) + std::abs(tangent.y) + std::abs(tangent.z));
  const auto fold = [](double a, double b) { return (1 - std::abs(b)) * (a < 0 ? -1 : 1); };
  const double x = t.z >= 0 ? t.x : fold(t.x, t.y), y = t.z >= 0 ? t.y : fold(t.y, t.x);
  return static_cast<u32>(std::lround((x * 0.5 + 0.5) * 65535)) |
         static_cast<u32>(std::lround((y * 0.5 + 0.5) * 32767)) << 16 | (mirrored ? 0x80000000u : 0u);
}

/// The vertex's tangent from the model's file, or `made`.
CornerTangent given_or(const Mesh& mesh, u32 vertex, const CornerTangent& made) {
  if (mesh.tangents.empty()) return made;
  const glm::vec4& given = mesh.tangents[vertex];
  const dvec3 tangent = unit_or_zero(dvec3(given));
  return tangent == dvec3(0) ? made : CornerTangent{tangent, given.w < 0};
}

}  // namespace

std::vector<CornerTangent> corner_tangents(const Mesh& mesh) {
  std::vector<CornerTangent> corners;
  corners.reserve(3 * mesh.triangles.size());
  std::unordered_map<CornerKey, dvec3, CornerHash> sums;
  std::vector<FaceTangent> faces(mesh.triangles.size());
  const auto normal_at = [&](std::size_t t, int corner) {
    if (mesh.normals.empty()) return faces[t].normal;
    return unit_or_zero(dvec3(mesh.normals[mesh.triangles[t][corner]]));
  };
  const auto key_of = [&](u32 vertex, bool mirrored) {
    const glm::vec3 p = mesh.positions[vertex], n = mesh.normals[vertex];
    const glm::vec2 uv = mesh.uvs[vertex];
    return CornerKey{{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}, mirrored};
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.uvs.empty()) faces[t] = face_tangent(mesh, mesh.triangles[t]);
    if (mesh.normals.empty() || faces[t].tangent == dvec3(0)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const dvec3 n = normal_at(t, corner);
      const dvec3 flat = unit_or_zero(faces[t].tangent - n * glm::dot(n, faces[t].tangent));
      sums[key_of(mesh.triangles[t][corner], faces[t].mirrored(n))] +=
          flat * angle_at(mesh, mesh.triangles[t], corner);
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int corner = 0; corner < 3; ++corner) {
      dvec3 tangent = faces[t].tangent;
      const bool mirrored = faces[t].mirrored(normal_at(t, corner));
      if (!mesh.normals.empty() && tangent != dvec3(0)) {
        const dvec3 mean = unit_or_zero(sums[key_of(mesh.triangles[t][corner], mirrored)]);
        if (mean != dvec3(0)) tangent = mean;
      }
      if (tangent == dvec3(0)) tangent = dvec3(1, 0, 0);
      corners.push_back(given_or(mesh, mesh.triangles[t][corner], {tangent, mirrored}));
    }
  return corners;
}

SharedTable<u32> tangents_of(const MappingInputs& in) {
  if (!in.relief) return {};
  std::vector<u32> table(3 * in.meshes->triangles.size());
  tbb::parallel_for(std::size_t{0}, in.sources->size(), [&](std::size_t i) {
    const Mesh* mesh = (*in.sources)[i];
    if (!mesh) return;
    u32* packed = table.data() + 3 * std::size_t{in.meshes->placed[i].first_triangle};
    for (const CornerTangent& corner : corner_tangents(*mesh))
      *packed++ = pack_tangent(corner.tangent, corner.mirrored);
  });
  return table;
}

}  // namespace sundog
