// Finds the scale of a field's values from its operations, bottom up.
#include "compile/fields/sdf_scale.h"

#include <algorithm>

#include "formula/list.h"

namespace sundog {
namespace {

// For built-in closed forms, a lower safety is a scale, not a margin. Users' formulas always count as uneven.
constexpr double even_safety = 0.8;

bool is_direct(const SdfNode& node) {
  return node.kind == SdfNode::Kind::formula &&
         node.formula.steps.back().definition.kind == FormulaKind::direct;
}

bool has_length(const SdfNode& node) {
  return node.kind == SdfNode::Kind::thicken || node.kind == SdfNode::Kind::shell || node.smooth > 0;
}

/// The scale of `node`'s values; the smallest if its parts differ.
double scale_of(const SdfNode& node) {
  if (node.children.empty()) return is_direct(node) ? node.formula.safety : 1;
  double least = 1;
  for (const SdfNode& child : node.children) least = std::min(least, scale_of(child));
  return least;
}

void multiply(SdfNode& node, double factor) {
  node.formula.safety *= factor;
  node.amount *= factor;
  node.smooth *= factor;
  for (SdfNode& child : node.children) multiply(child, factor);
}

void set_scale(SdfNode& node, double scale) {
  if (node.children.empty() || has_length(node)) return multiply(node, scale / scale_of(node));
  for (SdfNode& child : node.children) set_scale(child, scale);
}

}  // namespace

void level_scales(SdfNode& node) {
  for (SdfNode& child : node.children) level_scales(child);
  if (!has_length(node)) return;
  const double scale = scale_of(node);
  for (SdfNode& child : node.children) set_scale(child, scale);
  node.amount *= scale;
  node.smooth *= scale;
}

bool is_uneven(const SdfNode& node) {
  if (is_direct(node)) {
    const FormulaDefinition& own = node.formula.steps.back().definition;
    const FormulaDefinition* listed = find_formula(own.name);
    return !listed || listed->distance != own.distance || node.formula.safety < even_safety;
  }
  return std::any_of(node.children.begin(), node.children.end(), is_uneven);
}

}  // namespace sundog
