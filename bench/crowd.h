// A model become many: copies that are instances, and balls, for measurements of the two-level BVH.
#pragma once
#include "scene/description.h"

namespace sundog {

/// Puts `copies` of the scene's objects in a cubic lattice, each turned about its own axis and so close that
/// the boxes overlap, and `balls` exact spheres at random about them. The same numbers give the same scene.
/// Throws SceneError for a scene without a mesh.
void make_crowd(SceneDescription& scene, unsigned copies, unsigned balls);

}  // namespace sundog
