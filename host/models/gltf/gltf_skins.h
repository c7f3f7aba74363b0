// glTF's skins (glTF 2.0, section 3.7.3.3): moves vertices by joint matrices.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "models/values/mesh.h"

namespace sundog::models {

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
