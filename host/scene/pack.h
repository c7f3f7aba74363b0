// Packs a vector for tables: three floats and a fourth value.
#pragma once
#include <glm/glm.hpp>

#include "shared/types.h"

namespace sundog {

inline float4 pack(const glm::dvec3& v, double w = 0) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

}  // namespace sundog
