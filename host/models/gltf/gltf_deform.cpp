// Adds weighted morph targets; blends joint matrices by a vertex's weights, and moves positions and normals.
#include "models/gltf/gltf_deform.h"

#include <cmath>
#include <optional>

namespace sundog::models {
namespace {

/// The weighted mean of a vertex's joint matrices.
std::optional<glm::dmat4> blended(const std::vector<glm::dmat4>& matrices, const JointWeights& of,
                                  std::size_t vertex) {
  glm::dmat4 sum(0);
  double weights = 0;
  for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
    const auto weight = static_cast<double>(of.weights[i]);
    if (!(weight > 0)) continue;
    if (!(of.joints[i] >= 0 && of.joints[i] < static_cast<float>(matrices.size()))) return std::nullopt;
    sum += weight * matrices[static_cast<std::size_t>(of.joints[i])];
    weights += weight;
  }
  return weights > 0 ? std::optional(sum / weights) : std::nullopt;
}

/// The normal matrix up to a factor: the inverse transpose times the determinant.
glm::dmat3 for_normals(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

glm::vec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return glm::vec3(length > 0 ? v / length : v);
}

glm::vec3 change(const std::vector<float>& changes, std::size_t vertex) {
  const glm::vec3 v(changes[3 * vertex], changes[3 * vertex + 1], changes[3 * vertex + 2]);
  return std::isfinite(v.x + v.y + v.z) ? v : glm::vec3(0);
}

}  // namespace

void move_by_target(float weight, const TargetChanges& changes, const std::vector<std::uint32_t>& used,
                    std::size_t first, Mesh& mesh) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::size_t at = first + i;
    if (changes.positions) mesh.positions[at] += weight * change(*changes.positions, used[i]);
    if (changes.normals) mesh.normals[at] += weight * change(*changes.normals, used[i]);
    if (changes.tangents) mesh.tangents[at] += glm::vec4(weight * change(*changes.tangents, used[i]), 0);
  }
}

void move_by_joints(const std::vector<glm::dmat4>& matrices, const JointWeights& of,
                    const std::vector<std::uint32_t>& used, std::size_t first, Mesh& mesh) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto matrix = blended(matrices, of, used[i]);
    if (!matrix) continue;
    const std::size_t at = first + i;
    const glm::dmat3 turn(*matrix);
    mesh.positions[at] = glm::vec3(*matrix * glm::dvec4(glm::dvec3(mesh.positions[at]), 1));
    mesh.normals[at] = unit(for_normals(turn) * glm::dvec3(mesh.normals[at]));
    if (at < mesh.tangents.size()) {
      const glm::vec4 tangent = mesh.tangents[at];
      mesh.tangents[at] = glm::vec4(unit(turn * glm::dvec3(glm::vec3(tangent))), tangent.w);
    }
  }
}

}  // namespace sundog::models
