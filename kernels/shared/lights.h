// The lights that have a place or a direction, in one list: from it come LIGHT_*, the description's
// LightType, and the names in scene files and figures. Ambient lights are no part of it: they are summed into
// SceneInfo.ambient.
//   LIGHT(constant after LIGHT_, name, 1 = it has a position and a falloff, 1 = it has a direction)
#ifndef SUNDOG_SHARED_LIGHTS_H
#define SUNDOG_SHARED_LIGHTS_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define LIGHTS(LIGHT)                   \
  LIGHT(DIRECTIONAL, directional, 0, 1) \
  LIGHT(POINT, point, 1, 0)             \
  LIGHT(SPOT, spot, 1, 1)

#define LIGHT_CONSTANT(constant, name, placed, aimed) LIGHT_##constant,
typedef enum LightKind SUNDOG_ENUM_OF_U32 { LIGHTS(LIGHT_CONSTANT) } LightKind;
#undef LIGHT_CONSTANT

// 64 bytes.
typedef struct Light {
  float4 position;   // world
  float4 direction;  // unit, the way the light travels; w = cosine of the cone's outer half angle
  float4 color;      // times intensity; w = cosine of the cone's inner half angle
  float falloff_constant, falloff_linear,
      falloff_quadratic;  // intensity / (c + l d + q d^2), d in world units
  u32 kind;               // LIGHT_*
} Light;
SUNDOG_SHARED_SIZE(Light, 64)

SUNDOG_SHARED_END
#endif
