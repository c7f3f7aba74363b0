// Compiles patterns' formulas to OpenCL C ("generated/patterns.cl").
#pragma once
#include <span>
#include <string>

#include "formula/definition.h"

namespace sundog {

/// The text of generated/patterns.cl, whose pattern_formula() computes formula `number`. It depends only on
/// the formulas and their integer exponents; other parameters are read from its table argument. Throws
/// FormulaError.
std::string pattern_code(std::span<const PatternFormula> formulas);

}  // namespace sundog
