// Whether the round surfaces of two solids touch.
#pragma once
#include "compile/bounds.h"
#include "compile/shapes.h"

namespace sundog {

struct RoundSolid {
  UnitShape unit;
  dmat4 world_from_unit;
};

/// Whether the surfaces of two solids may touch, within `tolerance`, along their common tangents in `box`;
/// false where one of them is not round. Where it cannot be told with moderate work, true.
bool round_surfaces_touch(const RoundSolid& a, const RoundSolid& b, const Bounds& box, double tolerance);

}  // namespace sundog
