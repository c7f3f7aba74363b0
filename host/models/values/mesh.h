// A mesh of triangles.
#pragma once
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "models/values/mesh_array.h"

namespace sundog {

/// Triangles with shared vertices. `normals` (empty: flat shading), `uvs`, `tangents`, `colors` and `alphas`
/// are empty or as long as `positions`; colours are linear.
struct Mesh {
  std::string name;
  MeshArray<glm::vec3> positions;
  MeshArray<glm::vec3> normals;
  MeshArray<glm::vec2> uvs;                       // v up
  std::vector<MeshArray<glm::vec2>> further_uvs;  // sets 1, 2, ..., each empty or one per vertex
  MeshArray<glm::vec4> tangents;  // along u; w: sign of the bitangent. Empty: compile() computes them
  MeshArray<glm::vec3> colors;
  MeshArray<float> alphas;  // alpha of the colours, for TEXTURE_VERTEX_COLOR; empty: 1
  MeshArray<glm::uvec3> triangles;
  std::vector<int>
      materials;  // per triangle, index into the materials of the scene or model; empty: the object's
  std::size_t source_vertex_count = 0;  // in the file, before vertices are split or dropped
};

template <glm::length_t N, class T>
bool is_finite(const glm::vec<N, T>& v) {
  return std::isfinite(glm::dot(v, glm::vec<N, T>(0)));
}

/// A triangle's normal with twice its area as length; in double precision, so that tiny and huge triangles
/// have one.
inline glm::dvec3 face_normal(const Mesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3 p(mesh.positions[triangle.x]);
  return glm::cross(glm::dvec3(mesh.positions[triangle.y]) - p, glm::dvec3(mesh.positions[triangle.z]) - p);
}

}  // namespace sundog
