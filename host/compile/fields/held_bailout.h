// How far orbits may go before floats end.
#pragma once
#include "scene/formula/sdf.h"

namespace sundog {

/// The field's bailout or, where one more iteration from there could leave the range of floats, the greatest
/// radius from which none does: an orbit that has escaped this far escapes for good, and the estimate from
/// there is the same to a part in the radius. Throws FormulaError.
double held_bailout(const FormulaField& field);

}  // namespace sundog
