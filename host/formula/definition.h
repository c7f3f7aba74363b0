// FormulaDefinition: a formula's text, parameters and settings, before it is lowered.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "formula/error.h"

namespace sundog {

/// A named number, vec3 or quat (size 1, 3, 4) that a scene can set, each component within [minimum,
/// maximum]. whole: integers only.
struct FormulaParameter {
  std::string name;
  std::vector<double> value;
  double minimum = -1e6, maximum = 1e6;
  bool whole = false;
  std::string meaning = {};
  std::string old_name = {};  // also accepted
};

/// escape: the solid is the set of points whose orbit stays within the bailout radius; distance from |z| and
/// the derivative. folded: `distance` of the folded point, divided by the derivative; negative inside.
/// direct: `distance` of p.
enum class FormulaKind { escape, folded, direct };

/// Distance estimate of an escaped orbit from r = |z| and the derivative dr: r log r / (2 dr) or r / dr.
enum class EscapeEstimate { logarithmic, linear };

/// The derivative in the estimate. running: one number that bounds the growth of lengths. radial: likewise,
/// but a triplex power grows as along z only, n r^(n-1): common in other programs, faster, not a bound near
/// the poles. jacobian: the largest stretch of all partial derivatives of z. automatic: jacobian if the
/// running bound would be loose, else radial, or running for hybrids and maps that fold.
enum class FormulaDerivative { automatic, running, radial, jacobian };

struct FormulaDefinition {
  std::string name, title, source;
  FormulaKind kind = FormulaKind::escape;
  bool quaternion = false;           // z and c are quaternions
  std::string start, map, distance;  // statements; statements; one expression
  EscapeEstimate estimate = EscapeEstimate::logarithmic;
  FormulaDerivative derivative = FormulaDerivative::automatic;
  bool normalize = false;  // direct: the expression is not a distance; divide by its gradient's length
  std::vector<FormulaParameter> parameters;
  int iterations = 8;        // 1..max_iterations
  double bailout = 16;       // radius at which an orbit has escaped, 0: never
  double inside_radius = 2;  // escape: an orbit that stays within it may be inside (at most the bailout)
  // escape: factor on the depth estimate. Not a proven bound: orbits inside grow faster than their derivative
  // predicts.
  double inside_safety = 0.1;
  double safety = 1;      // (0, 1]: factor that makes the estimate a bound, as tests measure it
  double exceptions = 0;  // fraction of the interval where that may fail (triplex powers: near the poles)
  std::array<double, 6> bounds{-1.5, -1.5, -1.5, 1.5, 1.5, 1.5};  // default interval: lower, upper
  std::string old_name = {};                                      // also accepted
  bool smooth = false;  // without detail at every scale: hits are refined
  static constexpr int max_iterations = 1000;
  static constexpr std::size_t max_parameters = 32;
};

/// A pattern: text that ends in an expression, a number or a vec3, of the position `p` and the footprint
/// `width`, both in pattern units.
struct PatternFormula {
  std::string text;
  std::vector<FormulaParameter> parameters;
};

}  // namespace sundog
