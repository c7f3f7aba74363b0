// Samples a formula over its interval: whether it is finite, has an inside, and never overestimates distance.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "formula/evaluate.h"

namespace sundog {

/// A value and where it was found.
struct PlacedValue {
  double value = 0;
  glm::dvec3 at{0};
};

struct FormulaSurvey {
  int points = 0, finite = 0, inside = 0;
  glm::dvec3 lost{0};           // a point without a finite value, if finite < points
  PlacedValue least, greatest;  // estimates, refined by climbing from the points
  PlacedValue steepest;         // FieldValue::slope, refined likewise
  bool is_bounded = true;       // the search for the steepest slope converged
  /// The smallest ratio of true distance to estimate that was found, at most 1; the estimate is too long by
  /// at least its inverse.
  PlacedValue reach{1, glm::dvec3(0)};
  std::vector<DomainBreach> breaches;
};

/// Deterministic; samples 64 to 1024 points, fewer for costly formulas. `closely`: also finds the steepest
/// slope and the reach. Throws FormulaError.
FormulaSurvey survey_formula(const FormulaField& field, const glm::dvec3& lower, const glm::dvec3& upper,
                             bool closely);

}  // namespace sundog
