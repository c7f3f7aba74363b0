// The numbers that estimates are scaled by ("safety"), as the operations on them see it.
#pragma once
#include "scene/formula/sdf.h"

namespace sundog {

/// Brings all operands of an operation that has a length of its own (thicken, shell, rounded joints) to one
/// scale, and that length too, so that the safety of a formula moves no surface. Code of the user's own is
/// taken as it is.
void level_scales(SdfNode& node);

/// Near the surface of some formula under `node` an estimate may be a small part of the distance.
bool is_uneven(const SdfNode& node);

}  // namespace sundog
