// Runs the lowered graphs in the kernels' order: start, one map per turn until the orbit escapes, finish.
#include "formula/evaluate.h"

#include <algorithm>
#include <cmath>

namespace sundog {

namespace in = formula_input;

/// The graphs' inputs at one point of an orbit.
struct FormulaEvaluator::Orbit {
  glm::dvec3 p{0};
  std::vector<double> z, c, tangents, c_tangents;
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
    if (index >= in::tangent_c) return c_tangents[static_cast<std::size_t>(index - in::tangent_c)];
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

namespace {

/// The largest singular value of the Jacobian given by `tangents`, as in lib/sdf/sample.h.
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

void append(std::vector<NodeId>& to, const std::vector<std::array<NodeId, 3>>& rows) {
  for (const auto& row : rows) to.insert(to.end(), row.begin(), row.end());
}

/// The next `count` of `values`.
std::vector<double> take(const std::vector<double>& values, std::size_t& next, std::size_t count) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(next);
  next += count;
  return {first, first + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

FormulaEvaluator::FormulaEvaluator(const FormulaField& field) : field_(field) {
  for (const FormulaStep& step : field_.steps) {
    lowered_.push_back(lower(step.definition, step.values, lowered_.empty() ? nullptr : &lowered_[0].start));
    jacobian_ |= lowered_.back().jacobian;
    turns_ += step.times;
  }
  const std::size_t last = lowered_.size() - 1;
  const Section& finish = lowered_[last].finish;
  if (finish.distance != no_node)
    finish_ = part(finish, "distance", last,
                   {finish.distance, finish.gradient[0], finish.gradient[1], finish.gradient[2]});
  if (field_.steps[last].definition.kind == FormulaKind::direct) return;
  const Section& start = lowered_[0].start;
  std::vector<NodeId> outputs = start.z;
  outputs.insert(outputs.end(), start.c.begin(), start.c.end());
  append(outputs, start.z_tangents);
  append(outputs, start.c_tangents);
  if (start.derivative != no_node) outputs.push_back(start.derivative);
  if (start.c_slope != no_node) outputs.push_back(start.c_slope);
  start_ = part(start, "start", 0, std::move(outputs));
  for (std::size_t i = 0; i <= last; ++i) {
    const Section& map = lowered_[i].map;
    outputs = map.z;
    if (jacobian_)
      append(outputs, map.z_tangents);
    else
      outputs.push_back(map.derivative);
    maps_.push_back(part(map, "map", i, std::move(outputs)));
  }
}

FormulaEvaluator::Part FormulaEvaluator::part(const Section& section, const std::string& name,
                                              std::size_t step, std::vector<NodeId> outputs) {
  Part result;
  for (const DomainGuard& guard : section.guards) {
    result.guards.push_back(breaches_.size());
    breaches_.push_back({guard, name, step});
    outputs.push_back(guard.argument);
    outputs.push_back(guard.condition == no_node ? guard.argument : guard.condition);
  }
  met_.resize(breaches_.size());
  result.program = GraphProgram(section.graph, outputs);
  return result;
}

const std::vector<double>& FormulaEvaluator::run(Part& part, const Orbit& orbit) {
  const auto& values = part.program.run(std::cref(orbit));
  std::size_t place = values.size() - 2 * part.guards.size();
  for (const std::size_t index : part.guards) {
    DomainBreach& breach = breaches_[index];
    const double argument = values[place], condition = values[place + 1];
    place += 2;
    const bool used = breach.guard.condition == no_node || condition != 0;
    const double slack = 1e-6;  // for rounding
    if (!used || met_[index] ||
        !(argument < breach.guard.low - slack || argument > breach.guard.high + slack))
      continue;
    met_[index] = 1;
    if (breach.count++ > 0) continue;
    breach.value = argument;
    breach.at = orbit.p;
  }
  return values;
}

std::size_t FormulaEvaluator::cost() const {
  std::size_t maps = 0;
  for (std::size_t i = 0; i < maps_.size(); ++i)
    maps += maps_[i].program.size() * static_cast<std::size_t>(field_.steps[i].times);
  const auto rounds = static_cast<std::size_t>(field_.iterations);
  return start_.program.size() + finish_.program.size() +
         maps * rounds / static_cast<std::size_t>(std::max(turns_, 1));
}

void FormulaEvaluator::begin(Orbit& orbit) {
  const Section& start = lowered_[0].start;
  const auto& values = run(start_, orbit);
  std::size_t next = 0;
  orbit.z = take(values, next, start.z.size());
  orbit.c = take(values, next, start.z.size());
  orbit.tangents = take(values, next, 3 * start.z.size());
  orbit.c_tangents = take(values, next, 3 * start.z.size());
  if (start.derivative != no_node) orbit.derivative = values[next++];
  if (start.c_slope != no_node) orbit.c_slope = values[next++];
}

void FormulaEvaluator::iterate(Orbit& orbit) {
  int turn = orbit.iteration % turns_;
  std::size_t step = 0;
  while (turn >= field_.steps[step].times) turn -= field_.steps[step++].times;
  orbit.parameters = &field_.steps[step].values;
  const auto& values = run(maps_[step], orbit);
  std::size_t next = 0;
  orbit.z = take(values, next, orbit.z.size());
  if (jacobian_)
    orbit.tangents = take(values, next, 3 * orbit.z.size());
  else
    orbit.derivative = values[next];
}

double FormulaEvaluator::escape_distance(const Orbit& orbit) const {
  const double r = std::sqrt(orbit.square());
  const double level = orbit.iteration == field_.iterations ? field_.bailout : 0;  // as in lib/sdf/sample.h
  return field_.steps.back().definition.estimate == EscapeEstimate::logarithmic
             ? 0.5 * std::max(std::log(level > 0 ? r / level : r), 0.0) * r
             : r - level;
}

FieldValue FormulaEvaluator::at(const glm::dvec3& p) {
  const FormulaDefinition& d = field_.steps.back().definition;
  std::fill(met_.begin(), met_.end(), 0);
  Orbit orbit;
  orbit.p = p;
  orbit.parameters = &field_.steps[0].values;
  const auto slope = [&](const std::vector<double>& values) {
    return d.normalize ? 0 : std::sqrt(values[1] * values[1] + values[2] * values[2] + values[3] * values[3]);
  };
  if (d.kind == FormulaKind::direct) {
    const auto& values = run(finish_, orbit);
    const double distance = values[0] * field_.safety;
    return {distance, distance < 0, 0, slope(values)};
  }
  begin(orbit);
  const bool bails_out = d.kind == FormulaKind::escape || field_.bailout > 0;
  const auto is_out = [&] { return bails_out && !(orbit.square() < field_.bailout * field_.bailout); };
  bool escaped = is_out();
  for (; orbit.iteration < field_.iterations && !escaped; ++orbit.iteration) {
    iterate(orbit);
    escaped = is_out();
  }
  if (jacobian_) orbit.derivative = stretch_of(orbit.tangents);
  const double growth = std::max(orbit.derivative, 1e-30) / field_.safety;
  if (d.kind == FormulaKind::folded) {
    orbit.parameters = &field_.steps.back().values;
    std::fill(orbit.tangents.begin(), orbit.tangents.end(), 0);
    std::fill(orbit.c_tangents.begin(), orbit.c_tangents.end(), 0);
    for (std::size_t axis = 0; axis < 3; ++axis) orbit.tangents[4 * axis] = 1;  // by z, not p
    const auto& values = run(finish_, orbit);
    const double distance = values[0] / growth;
    return {distance, distance < 0, orbit.iteration, slope(values)};
  }
  if (!escaped) return {0, true, orbit.iteration};
  return {escape_distance(orbit) / growth, false, orbit.iteration};
}

std::optional<double> FormulaEvaluator::scale() {
  double logarithm = 0;
  for (std::size_t step = 0; step < maps_.size(); ++step) {
    const std::size_t size = lowered_[step].map.z.size();
    const auto growth_at = [&](double length, int iteration) {
      Orbit orbit;
      orbit.z.assign(size, length);
      orbit.c.assign(size, 0.5);
      orbit.tangents = orbit.c_tangents = std::vector<double>(3 * size);
      orbit.parameters = &field_.steps[step].values;
      orbit.iteration = iteration;
      const double before = orbit.square();
      const auto& values = maps_[step].program.run(std::cref(orbit));
      orbit.z.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(size));
      return std::sqrt(orbit.square() / before);
    };
    for (int i = 0; i < 4; ++i) {
      const double change = growth_at(1e12, i) / growth_at(1e8, i);
      if (!(change > 0.5 && change < 2)) return std::nullopt;
    }
    logarithm += field_.steps[step].times * std::log(growth_at(1e12, 0));
  }
  return std::exp(logarithm / turns_);
}

}  // namespace sundog
