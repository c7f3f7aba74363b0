// An edge that moves while the shutter is open, or before a moving camera, which gives a ramp of known width.
#pragma once
#include "device/device.h"
#include "scene/description.h"

namespace moving_edge {

/// Width and height of the picture in pixels.
inline constexpr int size = 64;

/// Pixels per unit at depth 1, in a picture of `size` pixels.
double pixels_a_unit(const sundog::SceneDescription& scene);

/// A glowing half plane from x = 0 to the right, at depth 5; one object.
sundog::SceneDescription scene();

/// Checks that the edge moves `way` units from the middle to the left while the shutter is open.
void check_ramp(const sundog::DeviceInfo& device, const sundog::SceneDescription& scene, double way);

}  // namespace moving_edge
