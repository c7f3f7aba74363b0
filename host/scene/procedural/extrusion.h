// A flat outline pulled up: letters, stars, plates, prisms.
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

}  // namespace sundog
