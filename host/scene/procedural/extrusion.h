// A flat outline pulled up: letters, stars, plates, prisms; and a photographer's sweep.
#pragma once
#include <vector>

#include "scene/description.h"
#include "scene/procedural/profile.h"

namespace sundog {

struct Extrusion {
  std::vector<procedural::ProfilePoint> outline;  // (x, -z): y is up on the page; closed by itself
  procedural::ProfileCurve curve = procedural::ProfileCurve::lines;
  double height = 1;  // from y = 0, above 0
  int facets = 64;    // of a full turn of the outline, 3..4096
};

/// A closed solid with the outline's exact normals on its sides and flat ends. Throws GenerateError for an
/// outline that crosses itself.
Mesh make_extrusion(const Extrusion& extrusion);

/// A floor that curves up to a wall behind, so that no horizon shows.
struct Sweep {
  glm::dvec2 size{8, 6};  // of the floor along x and z, the curve included; its middle is at the origin
  double height = 4;      // of the wall
  double radius = 1.5;    // of the curve
};

/// A sheet with exact normals, towards the floor's upper side; u along x and v up the sheet, in scene units.
/// Throws GenerateError for a radius above the height or the depth.
Mesh make_sweep(const Sweep& sweep);

}  // namespace sundog
