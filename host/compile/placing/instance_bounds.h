// Boxes of placed shapes in the world.
#pragma once
#include <span>

#include "compile/bounds.h"
#include "compile/shapes.h"

namespace sundog {

/// World bounds of a bounded shape, rounded outwards; unless `exact`, widened by what a kernel's transform of
/// a ray may round. `boxes` cover a mesh or a field (SHAPE_MESH, SHAPE_SDF), and are ignored else.
Bounds world_bounds(const UnitShape& unit, std::span<const Bounds> boxes, const dmat4& world_from_unit,
                    bool exact);

/// Boxes that hold an exact solid between them, `whole` being its world_bounds(): more than one where a cut
/// across its longest side leaves much less of `whole`, as of a thin solid that stands askew.
std::vector<Bounds> part_bounds(const UnitShape& unit, const dmat4& world_from_unit, const Bounds& whole);

/// The box's centre, and in w half its diagonal, rounded up.
float4 sphere_around(const Bounds& box);

}  // namespace sundog
