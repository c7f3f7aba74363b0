// Which meshes share a BVH: those that lie in each other, as liquid in ice.
#pragma once
#include <cstddef>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// The meshes of each BVH, in ascending order, of all that objects place; most have one of their own. Meshes
/// share one where a single object places each, by the same transform and without motion, and their boxes
/// overlap by much: nearly every ray would walk both of two trees in one place. At most 16 share one.
std::vector<std::vector<std::size_t>> mesh_groups(const SceneDescription& scene);

}  // namespace sundog
