// Makes a field from a formula of the list.
#pragma once
#include "formula/list.h"
#include "formula/lower.h"

namespace sundog {

/// The formula as a field with its default parameters, iterations, bailout and bounds.
inline SdfDescription default_field(const FormulaDefinition& d) {
  SdfDescription field;
  field.name = d.name;
  field.root.formula = {{{d, default_values(d), 1}}, d.iterations, d.bailout, d.safety};
  field.lower = {d.bounds[0], d.bounds[1], d.bounds[2]};
  field.upper = {d.bounds[3], d.bounds[4], d.bounds[5]};
  return field;
}

}  // namespace sundog
