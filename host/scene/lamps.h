// Code for each kind of light: the row in the lights table, and, for area lights, bounds and the visible
// object.
#pragma once
#include <glm/glm.hpp>
#include <string>

#include "scene/description.h"

namespace sundog {

/// A light and its place in the scene file, for messages.
struct NamedLight {
  const std::string& file;
  const LightDescription& light;
  const std::string& place;
};

/// The sides of a rectangle or the radii of a disk, perpendicular to `normal`, the direction of emission:
/// cross(u, v) is parallel to the normal. A rectangle's `v` is as close to the light's `up` as possible.
struct LampAxes {
  dvec3 u{1, 0, 0}, v{0, 0, 1}, normal{0, -1, 0};  // u and v in world units
};
LampAxes lamp_axes(const LightDescription& light);

/// The power emitted by a white light of intensity 1, divided by the square of a scene unit. For point and
/// spot lights, which fade with the square of the distance, `intensity` is 1/pi of the irradiance at distance
/// 1, as in the kernels.
double power_of_intensity(const LightDescription& light);

/// The light's table row, with positions relative to `origin`. Throws SceneError for a zero direction.
Light pack_light(const NamedLight& named, const dvec3& origin);

/// Bounds of an area light, its area, and luminance times area.
struct LampBounds {
  glm::vec3 lower, upper;
  double area;
  float power;
};
LampBounds lamp_bounds(const Light& row);

/// Adds an object with an emissive material for each visible area light.
void add_lamps(SceneDescription& scene);

}  // namespace sundog
