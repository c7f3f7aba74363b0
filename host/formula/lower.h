// Compiles a formula's text to checked scalar graphs with the derivative that its distance estimate needs.
//
// The derivative has two forms (definition.h). The running one is a dual number that carries, with every
// value v(p), a bound on |v(p + h) - v(p)| / |h|: rotations, reflections and translations keep it, a scale
// multiplies it, a power z^n multiplies it by the norm of its derivative (n r^(n-1) for quaternions, n
// r^(n-1) max(1, |sin nt / sin t|) for triplex numbers at angle t from their axis), sums add it. It is used
// while these bounds are tight (see Value::tight). The Jacobian is the exact derivative by forward-mode
// differentiation of the scalar graph; the estimate divides by its largest stretch.
#pragma once
#include <vector>

#include "formula/definition.h"
#include "formula/graph.h"
#include "formula/value.h"

namespace sundog {

/// Input indices of a graph.
namespace formula_input {
inline constexpr int p = 0, z = 3, c = 7, derivative = 11, c_slope = 12, iteration = 13, square = 14,
                     tangent_z = 16, tangent_c = 28, parameter = 40;
/// d z[component] / d p[axis]
constexpr int tangent_of_z(int component, int axis) { return tangent_z + component * 3 + axis; }
constexpr int tangent_of_c(int component, int axis) { return tangent_c + component * 3 + axis; }
}  // namespace formula_input

/// Straight-line code with named results; absent ones are empty or no_node.
struct Section {
  Graph graph;
  std::vector<NodeId> z, c;                                   // 3 or 4 components
  NodeId derivative = no_node, c_slope = no_node;             // of the running derivative
  std::vector<std::array<NodeId, 3>> z_tangents, c_tangents;  // per component and axis
  NodeId distance = no_node;
  std::array<NodeId, 3> gradient{no_node, no_node, no_node};  // of the distance
  std::vector<DomainGuard> guards;
};

/// start: p -> z, c. map: z, c, derivative -> z, derivative. finish: z, derivative, p -> distance, gradient.
/// A direct field has only `finish`.
struct LoweredFormula {
  int size = 3;           // components of z
  bool jacobian = false;  // derivative: the Jacobian's largest stretch; else the running one
  bool folds = false;     // Values::folds of the map
  Section start, map, finish;
};

/// Throws FormulaError. `values` are the parameters' components in order: an exponent that is a whole number
/// is compiled in. `start`: the start of a hybrid's first formula, else the definition's own.
LoweredFormula lower(const FormulaDefinition& definition, const std::vector<double>& values,
                     const Section* start = nullptr);

/// A pattern's code: one value, or the three of a colour.
struct LoweredPattern {
  Graph graph;
  std::vector<NodeId> values;
};

/// Throws FormulaError.
LoweredPattern lower_pattern(const PatternFormula& formula);

/// The default values of a definition's parameters, concatenated.
std::vector<double> default_values(const FormulaDefinition& definition);

}  // namespace sundog
