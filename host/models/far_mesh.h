// Meshes far from their own origin, whose shape floats would represent poorly.
#pragma once
#include <span>

#include "models/model.h"

namespace sundog::models {

/// An origin for positions in the box from `lower` to `upper`. Along an axis on which the box's centre is
/// farther from 0 than `far_sizes` sizes, it is the centre rounded to a multiple of a power of two above the
/// size, so that patterns whose period divides that stay in place; otherwise 0.
dvec3 near_origin(const dvec3& lower, const dvec3& upper, double far_sizes = 8);
dvec3 near_origin(std::span<const dvec3> positions, double far_sizes = 8);

/// Gives each far mesh its own origin and moves its objects to compensate. Positions keep their precision.
void bring_near(Model& model);

}  // namespace sundog::models
