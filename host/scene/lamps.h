// Lights with an extent as things that can be seen.
#pragma once
#include "scene/description.h"

namespace sundog {

/// The sides of a rectangle and the radii of a disk, at right angles to `normal`, the way the light travels:
/// cross(u, v) has the normal's direction. A rectangle's `v` lies as near to the light's `up` as it can.
struct LampAxes {
  dvec3 u{1, 0, 0}, v{0, 0, 1}, normal{0, -1, 0};  // u and v in world units
};
LampAxes lamp_axes(const LightDescription& light);

/// Adds an object for each visible light with an extent, of a material that shines as the light does.
void add_lamps(SceneDescription& scene);

}  // namespace sundog
