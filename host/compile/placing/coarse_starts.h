// Detects objects so large relative to their distance that floats cannot resolve details near the camera.
#pragma once
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// Secondary rays start `away` from the object's surface, the bound of a hit's rounding
/// (kernels/plain/shade/interaction.cl); `distance`, less than a hundred times that, is the camera's.
struct CoarseStart {
  std::string object;
  double away = 0, distance = 0;
};

/// `origin`: of the tables' coordinates. Skips fields, which offset rays differently.
std::vector<CoarseStart> coarse_starts(const SceneDescription& scene, const dvec3& origin);

}  // namespace sundog
