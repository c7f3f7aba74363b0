// Limits bailout radii to the range of floats.
#pragma once
#include "formula/sdf.h"

namespace sundog {

/// The field's bailout or, if another iteration from there could overflow floats, the largest radius from
/// which none does. An orbit that has escaped this far never returns, and the estimate from there differs by
/// about one part in the radius. Throws FormulaError.
double held_bailout(const FormulaField& field);

}  // namespace sundog
