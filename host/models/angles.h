// Computes many angles at once with vector instructions; atan2() would take half of the time to compute a
// mesh's normals.
#pragma once
#include <span>

namespace sundog::models {

/// angles[i] = atan2(sines[i], cosines[i]) in radians, 0 to pi, within 4e-16. sines >= 0; each pair may have
/// any common scale, but not both be 0. All spans have the same length.
void angles_of(std::span<const double> sines, std::span<const double> cosines, std::span<double> angles);

}  // namespace sundog::models
