// A formula evaluated on the host, in double precision: a reference for the devices, and a probe of what a
// user wrote.
#pragma once
#include <glm/glm.hpp>

#include "scene/formula/lower.h"
#include "scene/formula/sdf.h"

namespace sundog {

/// inside: an orbit that never escaped, or a negative distance. iterations: until escape.
struct FieldValue {
  double distance = 0;
  bool inside = false;
  int iterations = 0;
};

/// One formula, not a hybrid, lowered once and evaluated at many points.
class FormulaEvaluator {
 public:
  /// Throws FormulaError.
  explicit FormulaEvaluator(const FormulaField& field);
  /// The estimate, times the field's safety; 0 inside where the formula knows no depth.
  FieldValue at(const glm::dvec3& p) const;

 private:
  const FormulaField field_;
  LoweredFormula lowered_;
};

/// Evaluates a formula at points all over its interval. Throws FormulaError when it gives a finite distance
/// at none of them, or when no orbit escapes (the whole interval would be solid).
void probe_formula(const FormulaField& field, const glm::dvec3& lower, const glm::dvec3& upper);

}  // namespace sundog
