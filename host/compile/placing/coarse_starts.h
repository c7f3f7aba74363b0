// Detects objects so large relative to their distance that floats cannot resolve details near the camera.
#pragma once
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// An object whose secondary rays start `away` from its surface, by the bound of a hit's rounding
/// (kernels/plain/shade/interaction.cl), which exceeds 1/100 of its `distance` from the camera.
struct CoarseStart {
  std::string object;
  double away = 0, distance = 0;
};

/// `origin`: the origin of the tables. Skips fields, which offset rays differently.
std::vector<CoarseStart> coarse_starts(const SceneDescription& scene, const dvec3& origin);

}  // namespace sundog
