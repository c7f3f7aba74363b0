// Bounding boxes of placed shapes in the world.
#pragma once
#include <span>

#include "compile/bounds.h"
#include "compile/shapes.h"

namespace sundog {

/// World bounds of a bounded shape, rounded outwards; unless `exact`, widened by the rounding of a kernel's
/// ray transform. `boxes` cover a mesh or a field (SHAPE_MESH, SHAPE_SDF), and are ignored for others.
Bounds world_bounds(const UnitShape& unit, std::span<const Bounds> boxes, const dmat4& world_from_unit,
                    bool exact);

/// Boxes that together contain an exact solid, whose world_bounds() is `whole`: several if cutting `whole`
/// across its longest side saves much area, as for a thin solid placed obliquely.
std::vector<Bounds> part_bounds(const UnitShape& unit, const dmat4& world_from_unit, const Bounds& whole);

/// The box's centre, and half its diagonal, rounded up, in w.
float4 sphere_around(const Bounds& box);

}  // namespace sundog
