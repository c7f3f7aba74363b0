// Surfaces of revolution about y from a profile, and the liquid that fills such a vessel.
#pragma once
#include <vector>

#include "scene/description.h"
#include "scene/procedural/profile.h"

namespace sundog {

struct Lathe {
  std::vector<procedural::ProfilePoint> profile;  // (radius, height)
  procedural::ProfileCurve curve = procedural::ProfileCurve::lines;
  int segments = 256;  // around the axis, 3..4096
};

/// The surface with the profile's exact normals; u turns from +x to -z, v follows the profile's length. It is
/// closed and faces outwards if both ends of the profile are on the axis or the profile returns to its start;
/// otherwise it is a sheet that faces the right of the profile. Throws GenerateError for a profile that
/// crosses itself or the axis.
Mesh make_lathe(const Lathe& lathe);

/// make_lathe()'s surface as an exact solid, with its middle at y = 0, and the height of that middle. Throws
/// like make_lathe().
struct ExactLathe {
  LatheShape shape;
  double middle = 0;
};
ExactLathe exact_lathe(const Lathe& lathe);

/// The liquid in a vessel, up to y = `level` on the axis and higher by `meniscus` at the wall. It extends
/// into the wall by at most half of the wall's least thickness, so no surfaces coincide; the vessel needs the
/// higher priority. Throws GenerateError like make_lathe, and if the profile is not a vessel or the level is
/// not in it.
Mesh make_lathe_liquid(const Lathe& lathe, double level, double meniscus);
/// The liquid as an exact solid: its top is exact; within the wall it has the facets of the mesh's profile.
ExactLathe exact_lathe_liquid(const Lathe& lathe, double level, double meniscus);

}  // namespace sundog
