// Evaluates a formula on the host in double precision: a reference for devices, and a probe of users'
// formulas.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formula/lower.h"
#include "formula/sdf.h"

namespace sundog {

/// inside: the orbit never escaped, or the distance is negative. iterations: until escape.
struct FieldValue {
  double distance = 0;
  bool inside = false;
  int iterations = 0;
  /// Rate of change of the formula's "distance" by its derivative: per unit of p (direct), or of z at the
  /// orbit's end (folded). 0 for escape formulas and if the distance is divided by its gradient.
  double slope = 0;
};

/// Arguments outside a function's domain: at how many of the evaluated points, and the first of these.
struct DomainBreach {
  DomainGuard guard;
  std::string section;  // "start", "map" or "distance"
  std::size_t step = 0;
  int count = 0;
  double value = 0;
  glm::dvec3 at{0};
};

/// A formula or hybrid, lowered once and evaluated at many points.
class FormulaEvaluator {
 public:
  /// Throws FormulaError.
  explicit FormulaEvaluator(const FormulaField& field);
  /// The estimate times the field's safety; 0 inside if the formula gives no depth.
  FieldValue at(const glm::dvec3& p);
  /// The mean factor by which one iteration scales distant points; nothing unless every map scales them in
  /// proportion (the Mandelbox's does, a power does not).
  std::optional<double> scale();
  /// Maximum number of operations of an evaluation.
  std::size_t cost() const;
  /// Breaches at all points so far.
  const std::vector<DomainBreach>& breaches() const { return breaches_; }

 private:
  struct Orbit;
  struct Part {
    GraphProgram program;
    std::vector<std::size_t> guards;  // their arguments and conditions are the last outputs
  };
  Part part(const Section& section, const std::string& name, std::size_t step, std::vector<NodeId> outputs);
  const std::vector<double>& run(Part& part, const Orbit& orbit);
  void begin(Orbit& orbit);
  void iterate(Orbit& orbit);
  double escape_distance(const Orbit& orbit) const;

  FormulaField field_;
  std::vector<LoweredFormula> lowered_;
  bool jacobian_ = false;
  int turns_ = 0;
  Part start_, finish_;
  std::vector<Part> maps_;
  std::vector<DomainBreach> breaches_;
  std::vector<char> met_;
};

}  // namespace sundog
