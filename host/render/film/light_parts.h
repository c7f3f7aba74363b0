// The parts of a pixel's light (shared/light_parts.h), which sum to its colour.
#pragma once
#include <array>

#include "shared/light_parts.h"

namespace sundog {

using PartValues = std::array<float, LIGHT_PART_COUNT>;

/// Changes the parts by what rounding has lost, so that ((parts[0] + parts[1]) + parts[2]) + ... in floats is
/// `whole`, to the bit. The greatest part that can takes the difference.
void fit_sum(PartValues& parts, float whole);

}  // namespace sundog
