// The built-in surfaces, written in the formula language.
#pragma once
#include <string>
#include <vector>

#include "formula/sdf.h"

namespace sundog {

/// All surfaces, in the order in which `sundog formulas` prints them.
const std::vector<FormulaDefinition>& formula_list();

/// The surface with this name, current or old; nullptr if unknown.
const FormulaDefinition* find_formula(const std::string& name);

/// An operation that combines fields: its type in scene files, its keys, its effect.
struct FieldOperation {
  std::string type, keys, meaning;
};
const std::vector<FieldOperation>& field_operations();

/// The text of `sundog formulas`: every surface with parameters, defaults, ranges and source; then the
/// operations and the language.
std::string formula_list_text();

}  // namespace sundog
