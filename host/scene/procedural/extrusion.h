// Meshes from flat outlines that are pulled up: letters, stars, plates, prisms; and a photographer's sweep.
#pragma once
#include <vector>

#include "scene/description.h"
#include "scene/procedural/profile.h"

namespace sundog {

struct Extrusion {
  std::vector<procedural::ProfilePoint> outline;  // (x, -z): y is up on the page; closes itself
  procedural::ProfileCurve curve = procedural::ProfileCurve::lines;
  double height = 1;  // from y = 0
  int facets = 64;    // per full turn of the outline
};

/// A closed solid with flat ends and, on its sides, the outline's exact normals. Throws GenerateError for an
/// outline that crosses itself.
Mesh make_extrusion(const Extrusion& extrusion);

/// A floor that curves up into a wall behind, so that no horizon shows.
struct Sweep {
  glm::dvec2 size{8, 6};  // floor along x and z, including the curve; centred at the origin
  double height = 4;      // height of the wall
  double radius = 1.5;    // radius of the curve
};

/// A sheet with exact normals towards the floor's upper side; u along x and v up the sheet, in scene units.
/// Throws GenerateError if the radius exceeds the height or the depth.
Mesh make_sweep(const Sweep& sweep);

}  // namespace sundog
