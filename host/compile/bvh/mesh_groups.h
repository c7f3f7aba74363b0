// Finds the meshes that objects place, and those that should share a BVH because they are nested, like liquid
// in ice.
#pragma once
#include <cstddef>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// The meshes of each BVH, in ascending order; most have their own. Up to 16 meshes share one if each is
/// placed by a single object, with equal transforms and no motion, and their boxes overlap so much that
/// nearly every ray would traverse both trees.
std::vector<std::vector<std::size_t>> mesh_groups(const SceneDescription& scene);

/// The scene's meshes; null for a mesh that no object places.
std::vector<const Mesh*> placed_meshes(const SceneDescription& scene);

}  // namespace sundog
