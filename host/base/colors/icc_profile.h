// The ICC profile of sRGB, for programs that interpret colours only by profiles.
#pragma once
#include <string>

namespace sundog {

/// A display profile of version 4: the primaries adapted to D50, and IEC 61966-2-1's curve as a formula.
std::string srgb_icc_profile();

}  // namespace sundog
