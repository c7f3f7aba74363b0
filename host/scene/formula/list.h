// The list of surfaces that sundog knows by name. Each is a text in the formula language, like a user's own.
#pragma once
#include <string>
#include <vector>

#include "scene/formula/sdf.h"

namespace sundog {

/// All surfaces, in the order in which `sundog formulas` prints them.
const std::vector<FormulaDefinition>& formula_list();

/// nullptr when there is no such name.
const FormulaDefinition* find_formula(const std::string& name);

/// One formula with its default parameters, iterations and bailout, in its default interval.
SdfDescription default_field(const FormulaDefinition& definition);

/// What puts fields together: the type in a scene file, its keys, what it does.
struct FieldOperation {
  std::string type, keys, meaning;
};
const std::vector<FieldOperation>& field_operations();

/// The text of `sundog formulas`: every surface with its parameters, defaults, ranges and source; then the
/// operations and the language.
std::string formula_list_text();

}  // namespace sundog
