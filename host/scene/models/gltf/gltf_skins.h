// glTF's skins (glTF 2.0, section 3.7.3.3) as they stand in the file: nothing moves.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/description.h"

namespace sundog::models {

/// What moves the vertices of a primitive: four numbers of joints a vertex, and their weights.
struct JointWeights {
  const std::vector<float>& joints;
  const std::vector<float>& weights;
};

/// Moves the mesh's vertices from `first` on, which are the primitive's vertices `used`, by the joints'
/// matrices. A vertex without weights, or with a joint that does not exist, stays.
void move_by_joints(const std::vector<dmat4>& matrices, const JointWeights& of,
                    const std::vector<std::uint32_t>& used, std::size_t first, Mesh& mesh);

}  // namespace sundog::models
