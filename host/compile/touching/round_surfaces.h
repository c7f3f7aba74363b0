// Tests whether curved surfaces of two solids touch.
#pragma once
#include "compile/bounds.h"
#include "compile/shapes.h"

namespace sundog {

struct RoundSolid {
  UnitShape unit;
  dmat4 world_from_unit;
};

/// Whether the surfaces of two solids may touch, within `tolerance`, where they share tangents in `box`;
/// false if one is not curved, true if limited work cannot decide.
bool round_surfaces_touch(const RoundSolid& a, const RoundSolid& b, const Bounds& box, double tolerance);

}  // namespace sundog
