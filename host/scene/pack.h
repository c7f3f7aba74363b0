// Packs a vector and a fourth value into a float4 for the scene's tables.
#pragma once
#include <glm/glm.hpp>

#include "shared/types.h"

namespace sundog {

inline float4 pack(const glm::dvec3& v, double w = 0) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

}  // namespace sundog
