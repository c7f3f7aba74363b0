// The built-in surfaces by kind.
#pragma once
#include <vector>

#include "formula/definition.h"

namespace sundog {

std::vector<FormulaDefinition> escape_formulas();  // sets that do not escape
std::vector<FormulaDefinition> folded_formulas();  // kaleidoscopic and inversive
std::vector<FormulaDefinition> solid_formulas();   // closed forms

}  // namespace sundog
