// Corrects the parts of a pixel's light (shared/light_parts.h) so that they sum exactly to its colour.
#pragma once
#include <array>

#include "shared/light_parts.h"

namespace sundog {

using PartValues = std::array<float, LIGHT_PART_COUNT>;

/// ((parts[0] + parts[1]) + parts[2]) + ... in floats.
float sum_of(const PartValues& parts);

/// Corrects the parts for rounding, so that their sum is `whole`, bit for bit. The largest part that can
/// absorb the difference does; parts that are 0 stay 0. If parts much larger than `whole` cancel, floats may
/// have no such sum.
void fit_sum(PartValues& parts, float whole);

}  // namespace sundog
