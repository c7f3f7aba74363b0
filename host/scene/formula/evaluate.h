// A formula evaluated on the host, in double precision: a reference for the devices, and a probe of what a
// user wrote.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/formula/lower.h"
#include "scene/formula/sdf.h"

namespace sundog {

/// inside: an orbit that never escaped, or a negative distance. iterations: until escape.
struct FieldValue {
  double distance = 0;
  bool inside = false;
  int iterations = 0;
  /// How fast the formula's "distance" changes, by its derivative: per unit of length at p (direct), or of z
  /// at the orbit's end (folded). 0 for what escapes, and where the distance is divided by its gradient.
  double slope = 0;
};

/// An argument beyond a function's domain, met at `count` of the points asked for, and the first of them.
struct DomainBreach {
  DomainGuard guard;
  std::string section;  // "start", "map" or "distance"
  std::size_t step = 0;
  int count = 0;
  double value = 0;
  glm::dvec3 at{0};
};

/// A formula or a hybrid, lowered once and evaluated at many points.
class FormulaEvaluator {
 public:
  /// Throws FormulaError.
  explicit FormulaEvaluator(const FormulaField& field);
  /// The estimate, times the field's safety; 0 inside where the formula knows no depth.
  FieldValue at(const glm::dvec3& p);
  /// Operations that an evaluation takes at most.
  std::size_t cost() const;
  /// Of all points since the start.
  const std::vector<DomainBreach>& breaches() const { return breaches_; }

 private:
  struct Orbit;
  struct Part {
    GraphProgram program;
    std::vector<std::size_t> guards;  // whose arguments and conditions are its last outputs
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
