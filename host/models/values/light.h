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

/// A light. Members have the names of keys in scene files; scenes/scene.schema.json says which light has
/// which.
struct LightDescription {
  LightType type = LightType::point;
  dvec3 color{1};
  double intensity = 1;       // times color; an area light's radiance
  dvec3 position{0};          // an area light's centre
  dvec3 direction{0, -1, 0};  // the way the light travels; normalised later
  double inner_angle = 20;    // spot: half angles in degrees,
  double outer_angle = 30;    // 0 <= inner <= outer < 90
  bool square_edge = false;   // spot: between them s^2, else s^2 (3 - 2 s)
  double range = 0;           // point, spot: fades to 0 there; 0: it does not
  dvec3 falloff{1, 0, 0};     // constant, linear, quadratic
  dvec2 size{1};              // rectangle: across and along `up`
  dvec3 up{0, 1, 0};
  double radius = 0.5;  // disk, sphere
  double angle = 0;     // directional: its diameter in the sky in degrees; 0: a delta light
  int samples = 1;      // area lights: shadow rays that a surface sends
  bool visible = true;  // the camera's rays see it, where others do
  bool hidden = false;  // no ray meets it (scene/lamps.h places what they meet)
  std::string group{};  // its AOV; empty: none
};

}  // namespace sundog
