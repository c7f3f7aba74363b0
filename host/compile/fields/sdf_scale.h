// Scales of estimates ("safety"), for operations on them.
#pragma once
#include "formula/sdf.h"

namespace sundog {

/// Brings the operands and the length of an operation (thicken, shell, rounded joints) to one scale, so that
/// a formula's safety moves no surface. Users' native code is left as it is.
void level_scales(SdfNode& node);

/// Whether an estimate near the surface of a formula under `node` may be much smaller than the distance.
bool is_uneven(const SdfNode& node);

}  // namespace sundog
