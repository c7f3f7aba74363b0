#include "scene/formula/evaluate.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

namespace in = formula_input;

/// Inputs of the graphs at one moment of an orbit.
struct Orbit {
  glm::dvec3 p{0};
  std::vector<double> z, c, tangents;
  const std::vector<double>* parameters = nullptr;
  double derivative = 1, c_slope = 0;
  int iteration = 0;

  double square() const {
    double sum = 0;
    for (const double v : z) sum += v * v;
    return sum;
  }
  double operator()(int index) const {
    if (index >= in::parameter) return parameters->at(static_cast<std::size_t>(index - in::parameter));
    if (index >= in::tangent_c) return 0;
    if (index >= in::tangent_z) return tangents[static_cast<std::size_t>(index - in::tangent_z)];
    if (index == in::derivative) return derivative;
    if (index == in::c_slope) return c_slope;
    if (index == in::iteration) return iteration;
    if (index == in::square) return square();
    if (index >= in::c) return c[static_cast<std::size_t>(index - in::c)];
    if (index >= in::z) return z[static_cast<std::size_t>(index - in::z)];
    return p[index];
  }
};

/// The greatest singular value of the Jacobian that the tangents are, by the formula of lib/sdf/sample.h.
double stretch_of(const std::vector<double>& tangents) {
  double a[3][3] = {};
  for (std::size_t row = 0; row + 2 < tangents.size(); row += 3)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) a[i][j] += tangents[row + i] * tangents[row + j];
  const double mean = (a[0][0] + a[1][1] + a[2][2]) / 3;
  double spread = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) spread += (a[i][j] - (i == j ? mean : 0)) * (a[i][j] - (i == j ? mean : 0));
  return std::sqrt(mean + 2 * std::sqrt(spread / 6));
}

}  // namespace

FormulaEvaluator::FormulaEvaluator(const FormulaField& field)
    : field_(field), lowered_(lower(field.steps.at(0).definition, field.steps.at(0).values)) {}

FieldValue FormulaEvaluator::at(const glm::dvec3& p) const {
  const FormulaDefinition& d = field_.steps[0].definition;
  Orbit orbit;
  orbit.p = p;
  orbit.parameters = &field_.steps[0].values;
  const auto one = [&](const Section& s, NodeId id) {
    return evaluate(s.graph, std::vector<NodeId>{id}, orbit)[0];
  };
  if (d.kind == FormulaKind::direct) {
    const double distance = one(lowered_.finish, lowered_.finish.distance) * field_.safety;
    return {distance, distance < 0, 0};
  }
  const Section& start = lowered_.start;
  orbit.z = evaluate(start.graph, start.z, orbit);
  orbit.c = evaluate(start.graph, start.c, orbit);
  if (start.derivative != no_node) orbit.derivative = one(start, start.derivative);
  if (start.c_slope != no_node) orbit.c_slope = one(start, start.c_slope);
  std::vector<NodeId> map = lowered_.map.z, tangent_nodes, first_tangents;
  for (const auto& row : start.z_tangents)
    first_tangents.insert(first_tangents.end(), row.begin(), row.end());
  orbit.tangents = evaluate(start.graph, first_tangents, orbit);
  if (lowered_.jacobian)
    for (const auto& row : lowered_.map.z_tangents) map.insert(map.end(), row.begin(), row.end());
  else
    map.push_back(lowered_.map.derivative);
  const bool bails_out = d.kind == FormulaKind::escape || field_.bailout > 0;
  bool escaped = bails_out && !(orbit.square() < field_.bailout * field_.bailout);
  for (; orbit.iteration < field_.iterations && !escaped; ++orbit.iteration) {
    const auto next = evaluate(lowered_.map.graph, map, orbit);
    const auto size = static_cast<std::ptrdiff_t>(orbit.z.size());
    orbit.z.assign(next.begin(), next.begin() + size);
    if (lowered_.jacobian)
      orbit.tangents.assign(next.begin() + size, next.end());
    else
      orbit.derivative = next.back();
    escaped = bails_out && !(orbit.square() < field_.bailout * field_.bailout);
  }
  if (lowered_.jacobian) orbit.derivative = stretch_of(orbit.tangents);
  const double growth = std::max(orbit.derivative, 1e-30) / field_.safety;
  if (d.kind == FormulaKind::folded) {
    const double distance = one(lowered_.finish, lowered_.finish.distance) / growth;
    return {distance, distance < 0, orbit.iteration};
  }
  if (!escaped) return {0, true, orbit.iteration};
  const double r = std::sqrt(orbit.square());
  const double level = orbit.iteration == field_.iterations ? field_.bailout : 0;  // as in lib/sdf/sample.h
  const double reach = d.estimate == EscapeEstimate::logarithmic
                           ? 0.5 * std::max(std::log(level > 0 ? r / level : r), 0.0) * r
                           : r - level;
  return {reach / growth, false, orbit.iteration};
}

void probe_formula(const FormulaField& field, const glm::dvec3& lower, const glm::dvec3& upper) {
  const FormulaEvaluator evaluator(field);
  constexpr int points = 64;
  int finite = 0, inside = 0;
  for (int i = 0; i < points; ++i) {
    // Points of an additive sequence with the plastic number's powers (M. Roberts, 2018), which leave no
    // gaps.
    const double n = i + 0.5;
    const glm::dvec3 place = glm::fract(n * glm::dvec3(0.8191725134, 0.6710436067, 0.5497004779));
    const FieldValue value = evaluator.at(glm::mix(lower, upper, place));
    finite += std::isfinite(value.distance);
    inside += value.inside && std::isfinite(value.distance);
  }
  const std::string of = " of " + std::to_string(points) + " points of its interval";
  if (finite == 0) throw FormulaError(0, 0, "gives a finite distance at none" + of);
  if (inside == points && field.steps[0].definition.kind == FormulaKind::escape)
    throw FormulaError(0, 0, "lets the orbit escape from none" + of + ": the whole interval would be solid");
}

}  // namespace sundog
