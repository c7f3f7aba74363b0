// Evaluates each map in doubles at 24 points on a sphere, and bisects the radius down to one whose values
// floats can hold.
#include "compile/fields/held_bailout.h"

#include <cmath>

#include "formula/lower.h"

namespace sundog {
namespace {

namespace in = formula_input;

constexpr double least_bailout = 4;      // below, orbits of usual maps may return
constexpr double greatest_part = 5e17;   // limit of a position, whose square must not overflow
constexpr double greatest_value = 1e37;  // limit of all values in an iteration

/// The growth of one map at a given distance.
class Growth {
 public:
  Growth(const LoweredFormula& formula, const std::vector<double>& parameters)
      : size_(static_cast<std::size_t>(formula.size)), parameters_(parameters), parts_(formula.map.z.size()) {
    std::vector<NodeId> all = formula.map.z;
    for (NodeId id = 0; id < formula.map.graph.size(); ++id) all.push_back(id);
    program_ = GraphProgram(formula.map.graph, all);
  }

  /// Whether floats can hold an iteration from `radius`, in directions all round.
  bool holds(double radius) {
    for (int i = 0; i < 24; ++i) {
      point_at(i, radius);
      const auto& values = program_.run([&](int index) { return input(index); });
      for (std::size_t k = 0; k < values.size(); ++k)
        if (std::abs(values[k]) > (k < parts_ ? greatest_part : greatest_value)) return false;
    }
    return true;
  }

 private:
  /// Points of an additive sequence, which leaves no gaps; off the axes, where some maps have poles.
  void point_at(int i, double radius) {
    const double steps[4] = {0.8191725134, 0.6710436067, 0.5497004779, 0.4503599627};
    double square = 0;
    for (std::size_t k = 0; k < size_; ++k) {
      const double place = (i + 0.5) * steps[k], at = 2 * (place - std::floor(place)) - 1;
      z_[k] = at + std::copysign(0.2, at);
      square += z_[k] * z_[k];
    }
    for (std::size_t k = 0; k < size_; ++k) z_[k] *= radius / std::sqrt(square);
    square_ = radius * radius;
  }

  double input(int index) const {
    if (index >= in::parameter) return parameters_[static_cast<std::size_t>(index - in::parameter)];
    if (index >= in::z && index < in::z + 4) return z_[index - in::z];
    if (index == in::square) return square_;
    return 1;
  }

  std::size_t size_;
  const std::vector<double>& parameters_;
  std::size_t parts_;
  GraphProgram program_;
  double z_[4] = {}, square_ = 0;
};

}  // namespace

double held_bailout(const FormulaField& field) {
  double bailout = field.bailout;
  Section start;
  for (const FormulaStep& step : field.steps) {
    if (step.definition.kind == FormulaKind::direct || !(bailout > least_bailout)) return bailout;
    const LoweredFormula formula =
        lower(step.definition, step.values, &step == &field.steps[0] ? nullptr : &start);
    if (&step == &field.steps[0]) start = formula.start;
    Growth growth(formula, step.values);
    if (growth.holds(bailout)) continue;
    double held = std::log(least_bailout), lost = std::log(bailout);
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (held + lost);
      (growth.holds(std::exp(middle)) ? held : lost) = middle;
    }
    bailout = std::exp(held);
  }
  return bailout;
}

}  // namespace sundog
