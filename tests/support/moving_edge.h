// An edge that moves while the shutter is open, by itself or with the camera: a ramp of known width.
#pragma once
#include "device/device.h"
#include "scene/description.h"

namespace moving_edge {

/// Pixels across of the square picture.
inline constexpr int size = 64;

/// Across `size` pixels, at the depth 1.
double pixels_a_unit(const sundog::SceneDescription& scene);

/// A glowing half plane from x = 0 to the right, at the depth 5; one object.
sundog::SceneDescription scene();

/// Checks that the edge runs `way` units to the left of the middle while the shutter is open.
void check_ramp(const sundog::DeviceInfo& device, const sundog::SceneDescription& scene, double way);

}  // namespace moving_edge
