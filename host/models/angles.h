// Angles of many corners at a time, in vector instructions: atan2() takes half of the time of a mesh's
// normals.
#pragma once
#include <span>

namespace sundog::models {

/// angles[i] = atan2(sines[i], cosines[i]), in radians, 0 to pi, within 4e-16 of it; sines >= 0, in any scale
/// that both share, not both 0. All spans have the same length.
void angles_of(std::span<const double> sines, std::span<const double> cosines, std::span<double> angles);

}  // namespace sundog::models
