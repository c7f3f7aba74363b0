// Moves vertices by morph targets and by joint matrices (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "models/values/mesh.h"

namespace sundog::models {

/// A morph target's changes of attributes, three numbers for each vertex of the primitive; null: none.
struct TargetChanges {
  const std::vector<float>*positions = nullptr, *normals = nullptr, *tangents = nullptr;
};

/// Adds `weight` times the changes to the mesh's vertices from `first` on, which are the primitive's vertices
/// `used`. A change that is no number counts as none. Leaves normals and tangents with other lengths.
void move_by_target(float weight, const TargetChanges& changes, const std::vector<std::uint32_t>& used,
                    std::size_t first, Mesh& mesh);

/// A primitive's skinning attributes: four joints per vertex and their weights.
struct JointWeights {
  const std::vector<float>& joints;
  const std::vector<float>& weights;
};

/// Skins the mesh's vertices from `first` on, which are the primitive's vertices `used`. A vertex without
/// weights, or with an invalid joint, stays.
void move_by_joints(const std::vector<glm::dmat4>& matrices, const JointWeights& of,
                    const std::vector<std::uint32_t>& used, std::size_t first, Mesh& mesh);

}  // namespace sundog::models
