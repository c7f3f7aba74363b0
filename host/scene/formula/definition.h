// A formula before it is lowered: its text, its parameters, and what else belongs to a surface of the list.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "scene/formula/error.h"

namespace sundog {

/// A named number, vec3 or quat (size 1, 3, 4) that a scene can set within [minimum, maximum] for every
/// component. whole: only integers.
struct FormulaParameter {
  std::string name;
  std::vector<double> value;
  double minimum = -1e6, maximum = 1e6;
  bool whole = false;
  std::string meaning = {};
  std::string old_name = {};  // is read as well
};

/// escape: the solid is what stays within the bailout radius; its distance comes from |z| and the derivative.
/// folded: `distance` of the folded point, divided by the derivative; negative inside.
/// direct: `distance` of p alone.
enum class FormulaKind { escape, folded, direct };

/// How an escape's distance is made of r = |z| and the derivative dr: r log r / (2 dr) or r / dr.
enum class EscapeEstimate { logarithmic, linear };

/// Which derivative the estimate divides by. running: one number, a bound on the growth of lengths. radial:
/// the same with the triplex power's growth along z alone, n r^(n-1): what most programs use, faster and no
/// bound near the poles. jacobian: all partial derivatives of z and their greatest stretch. automatic:
/// jacobian where the rules would give away too much, else radial, or running where the map folds or is a
/// hybrid's.
enum class FormulaDerivative { automatic, running, radial, jacobian };

struct FormulaDefinition {
  std::string name, title, source;
  FormulaKind kind = FormulaKind::escape;
  bool quaternion = false;           // z and c are quaternions
  std::string start, map, distance;  // statements; statements; one expression
  EscapeEstimate estimate = EscapeEstimate::logarithmic;
  FormulaDerivative derivative = FormulaDerivative::automatic;
  bool normalize =
      false;  // direct: divide by the gradient's length (the expression is no distance by itself)
  std::vector<FormulaParameter> parameters;
  int iterations = 8;        // 1..max_iterations
  double bailout = 16;       // radius at which an orbit has escaped, 0: never
  double inside_radius = 2;  // escape: an orbit within it may still be inside (at most the bailout)
  // escape: share of the depth's estimate that is taken. No proven bound: orbits inside grow faster than
  // their derivative foretells.
  double inside_safety = 0.1;
  double safety = 1;      // (0, 1]: the estimate times this is a bound, as measured by the tests
  double exceptions = 0;  // share of the interval in which it may fail (of triplex powers: near the poles)
  std::array<double, 6> bounds{-1.5, -1.5, -1.5, 1.5, 1.5, 1.5};  // default interval: lower, upper
  std::string old_name = {};                                      // is read as well
  bool smooth = false;  // a surface without detail at every scale: hits are refined
  static constexpr int max_iterations = 1000;
  static constexpr std::size_t max_parameters = 32;
};

/// A pattern: a text that ends in an expression, a number or a vec3, in `p`, the place, and `width`, how wide
/// what is seen there is, both in the pattern's units.
struct PatternFormula {
  std::string text;
  std::vector<FormulaParameter> parameters;
};

}  // namespace sundog
