// Meshes whose own coordinates lie far from their origin: floats would hold little of their shape.
#pragma once
#include <span>

#include "scene/model.h"

namespace sundog::models {

/// Where positions in the box from `lower` to `upper` should count from: along each axis on which the box's
/// middle is farther than `far_sizes` of its sizes, that middle to a power of two above the size (so that
/// patterns of a size that divides it stay in place), else 0.
dvec3 near_origin(const dvec3& lower, const dvec3& upper, double far_sizes = 8);
dvec3 near_origin(std::span<const dvec3> positions, double far_sizes = 8);

/// Gives each mesh that is far an origin of its own, and moves the objects that place it in turn. What the
/// floats hold is kept.
void bring_near(Model& model);

}  // namespace sundog::models
