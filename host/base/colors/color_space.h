// Linear colour spaces: their primaries, and matrices that convert between them.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// Chromaticities (CIE 1931 x and y) of red, green, blue and white.
struct Primaries {
  glm::dvec2 red, green, blue, white;
};

inline constexpr Primaries srgb_primaries = {{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3127, 0.329}};
/// ACES 2065-1 and ACEScg (SMPTE ST 2065-1, Academy S-2014-004).
inline constexpr Primaries ap0_primaries = {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}};
inline constexpr Primaries ap1_primaries = {
    {0.713, 0.293}, {0.165, 0.83}, {0.128, 0.044}, {0.32168, 0.33767}};

/// CIE XYZ of a chromaticity at luminance 1.
glm::dvec3 xyz_of(glm::dvec2 chromaticity);

/// The matrix from a space's colours to CIE XYZ; white has luminance 1. Not finite for collinear primaries.
glm::dmat3 xyz_from(const Primaries& space);

/// The matrix that adapts XYZ from one white to another (Bradford: Lam 1985).
glm::dmat3 adaptation(glm::dvec2 from_white, glm::dvec2 to_white);

/// The matrix from one space's colours to the other's; maps white to white.
glm::dmat3 conversion(const Primaries& from, const Primaries& to);

}  // namespace sundog
