// Lowers the field's least threshold to the pixel's footprint and adds an iteration per doubling of
// magnification; sdf.cpp emits the code of deep fields.
#include "compile/fields/sdf_deep.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

constexpr double default_least = 3e-5;  // relative to half the interval's diagonal, as in the reader

/// Each doubling of magnification needs about one more iteration of a quadratic map.
void add_iterations(SdfNode& node, int more) {
  FormulaField& formula = node.formula;
  if (node.kind == SdfNode::Kind::formula) {
    const FormulaDefinition& last = formula.steps.back().definition;
    if (last.kind != FormulaKind::direct && formula.iterations == last.iterations)
      formula.iterations = std::min(formula.iterations + more, FormulaDefinition::max_iterations);
  }
  for (SdfNode& child : node.children) add_iterations(child, more);
}

bool has_default_least(const SdfDescription& field) {
  return field.least == default_least * (glm::length(field.upper - field.lower) / 2);
}

}  // namespace

SdfDescription near_description(SdfDescription field, const FieldView& view) {
  const bool deep = is_deep(view);
  if (!(view.footprint > 0)) return field;
  const double size = glm::length(field.upper - field.lower) / 2;
  const double wanted = 0.25 * view.footprint * field.detail.value_or(0.05);
  if (has_default_least(field))
    field.least = std::min(field.least, deep ? wanted : std::max(wanted, 1e-6 * size));
  if (deep) add_iterations(field.root, static_cast<int>(std::ceil(std::log2(1e-3 * size / view.footprint))));
  return field;
}

}  // namespace sundog
