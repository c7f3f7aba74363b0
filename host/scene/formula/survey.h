// What a formula does all over its interval: whether it gives numbers, has an inside, and is the distance
// that sphere tracing takes it for.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scene/formula/evaluate.h"

namespace sundog {

/// A value and the point that it was found at.
struct PlacedValue {
  double value = 0;
  glm::dvec3 at{0};
};

struct FormulaSurvey {
  int points = 0, finite = 0, inside = 0;
  glm::dvec3 lost{0};           // a point without a finite number, where finite < points
  PlacedValue least, greatest;  // of the estimates; searched beyond the points
  PlacedValue steepest;         // of the slopes (FieldValue), likewise
  bool is_bounded = true;       // the search for the steepest slope came to an end
  /// The least ratio, 1 at most, of the way to a point of the surface and the estimate: found, so that the
  /// estimate is too long by at least as much.
  PlacedValue reach{1, glm::dvec3(0)};
  std::vector<DomainBreach> breaches;
};

/// The same for the same formula and interval; some ten thousand operations a point, up to a thousand points.
/// `closely`: with the search for the steepest slope, and the reach. Throws FormulaError.
FormulaSurvey survey_formula(const FormulaField& field, const glm::dvec3& lower, const glm::dvec3& upper,
                             bool closely);

}  // namespace sundog
