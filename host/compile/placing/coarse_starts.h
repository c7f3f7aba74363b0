// Objects so large beside their distance from the camera that floats do not tell what lies close to them.
#pragma once
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// Rays leave the object `away` off its surface, as far as rounding may place a hit beside it
/// (kernels/lib/shade/interaction.cl); `distance`, less than a hundred times as much, is the camera's.
struct CoarseStart {
  std::string object;
  double away = 0, distance = 0;
};

/// `origin`: of the tables' coordinates. Fields are left out: rays leave them by their own rules.
std::vector<CoarseStart> coarse_starts(const SceneDescription& scene, const dvec3& origin);

}  // namespace sundog
