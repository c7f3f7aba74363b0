// The parts of a pixel's light (shared/light_parts.h), which sum to its colour.
#pragma once
#include <array>

#include "shared/light_parts.h"

namespace sundog {

using PartValues = std::array<float, LIGHT_PART_COUNT>;

/// ((parts[0] + parts[1]) + parts[2]) + ... in floats.
float sum_of(const PartValues& parts);

/// Changes the parts by what rounding has lost, so that their sum is `whole`, to the bit. The greatest part
/// that can takes the difference; those that are 0 stay so. Where parts cancel that are far greater than
/// `whole`, floats may have no such sum.
void fit_sum(PartValues& parts, float whole);

}  // namespace sundog
