// A light, as a scene file or a model describes it.
#pragma once
#include <glm/glm.hpp>
#include <string>

#include "shared/lights.h"

namespace sundog {

using glm::dvec2;
using glm::dvec3;

#define SUNDOG_LIGHT_TYPE(constant, name, placed, aimed, extent) name,
enum class LightType { ambient, LIGHTS(SUNDOG_LIGHT_TYPE) };
#undef SUNDOG_LIGHT_TYPE

/// A light; members are the keys in LIGHT_KEYS (shared/lights.h).
struct LightDescription {
  LightType type = LightType::point;
#define SUNDOG_LIGHT_MEMBER(type, name, ...) type name __VA_ARGS__;
  LIGHT_KEYS(SUNDOG_LIGHT_MEMBER)
#undef SUNDOG_LIGHT_MEMBER
};

}  // namespace sundog
