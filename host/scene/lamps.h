// Lights: all that only one kind of them knows. Its keys in scene files, its row in the table of lights, and
// the box around it and the thing that rays meet where it has an extent.
#pragma once
#include <glm/glm.hpp>
#include <string>

#include "scene/description.h"

namespace sundog {

class JsonObject;

/// The keys of a light beside its type, color, intensity and position.
void read_light_kind(JsonObject& object, LightDescription& light);

/// The shadow rays to light that comes from many directions.
void read_light_sampling(JsonObject& object, int& samples);

/// Whether rays meet it.
void read_light_visible(JsonObject& object, bool& visible, bool& hidden);

/// A light and its place in the scene file, for messages.
struct NamedLight {
  const SceneDescription& scene;
  const LightDescription& light;
  const std::string& place;
};

/// The sides of a rectangle and the radii of a disk, at right angles to `normal`, the way the light travels:
/// cross(u, v) has the normal's direction. A rectangle's `v` lies as near to the light's `up` as it can.
struct LampAxes {
  dvec3 u{1, 0, 0}, v{0, 0, 1}, normal{0, -1, 0};  // u and v in world units
};
LampAxes lamp_axes(const LightDescription& light);

/// The light's row, whose position counts from `origin`. Throws SceneError for a direction of length zero.
Light pack_light(const NamedLight& named, const dvec3& origin);

/// The box around a light with an extent, the area that shines, and its luminance times that area.
struct LampBounds {
  glm::vec3 lower, upper;
  double area;
  float power;
};
LampBounds lamp_bounds(const Light& light);

/// Adds an object for each visible light with an extent, of a material that shines as the light does.
void add_lamps(SceneDescription& scene);

}  // namespace sundog
