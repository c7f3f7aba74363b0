// A leaf's functions: what its orbit's end, or its direct formula, says of the distance. See sdf_leaf.h.
#include "compile/fields/sdf_leaf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compile/fields/sdf_leaf_emitter.h"

namespace sundog {
namespace {

void check(const FormulaField& field) {
  if (field.steps.empty()) throw FormulaError(0, 0, "a field needs a formula");
  const FormulaDefinition& first = field.steps.front().definition;
  for (const FormulaStep& step : field.steps) {
    if (field.steps.size() > 1 && step.definition.kind == FormulaKind::direct)
      throw FormulaError(0, 0,
                         "'" + step.definition.name + "' is no iteration and cannot be part of a hybrid");
    if (step.definition.quaternion != first.quaternion)
      throw FormulaError(0, 0,
                         "'" + step.definition.name + "' and '" + first.name +
                             "' cannot follow each other: one is of quaternions, the other of points");
  }
}

}  // namespace

std::string LeafEmitter::function() {
  static const char* const names[] = {"distance", "signed", "sample"};
  const bool sample = variant_ == Variant::sample;
  std::string out = fmt::format("static inline {} NAME_{}(REAL3 p, MASK active, SDF_TABLE q) {{\n",
                                sample ? "SdfSample" : "REAL", names[static_cast<int>(variant_)]);
  out += last_->kind == FormulaKind::direct ? direct() : iterated();
  return out + "}\n\n";
}

std::string LeafEmitter::direct() {
  const Section& s = lowered_[0].finish;
  std::vector<NodeId> outputs{s.distance};
  const bool sample = variant_ == Variant::sample;
  if (sample) outputs.insert(outputs.end(), s.gradient.begin(), s.gradient.end());
  GraphPrinter print = printer(0, s, outputs, "f");
  std::string out = print.remaining_statements();
  const std::string distance = fmt::format("{} * q[{}]", print.text(s.distance), leaf_slot::safety);
  if (!sample) return out + "    return finite_distance(" + distance + ");\n";
  // Of the distance that is returned; where it is divided by its gradient, to first order about the
  // surface.
  const std::string gradient = fmt::format("real3({}, {}, {})", print.text(s.gradient[0]),
                                           print.text(s.gradient[1]), print.text(s.gradient[2]));
  out += fmt::format(
      "    const REAL r2 = square_length3(p.x, p.y, p.z);\n    SdfSample s = {{finite_distance({}), "
      "scale3({}, (REAL)(q[{}])),\n"
      "        r2, real_min(fabs(p.x), real_min(fabs(p.y), fabs(p.z))), r2, (REAL)(0.0f)}};\n"
      "    s.point = real_sqrt(r2);\n    s.axis = axis_distance(p.x, p.y, p.z);\n    return s;\n",
      distance, last_->normalize ? "unit3(" + gradient + ")" : gradient, leaf_slot::safety);
  return out;
}

std::string LeafEmitter::gradient_of_length() const {
  std::string out;
  for (int axis = 0; axis < 3; ++axis) {
    std::string sum = fmt::format("{} * t{}", z_names[size_ - 1], (size_ - 1) * 3 + axis);
    for (int i = size_ - 2; i >= 0; --i) sum = fmt::format("fma({}, t{}, {})", z_names[i], i * 3 + axis, sum);
    out += fmt::format("    const REAL g{} = {};\n", axis, sum);
  }
  return out;
}

std::string LeafEmitter::escape_distance() const {
  const char* form = last_->estimate == EscapeEstimate::logarithmic ? "logarithmic" : "linear";
  const char* square = latched() ? "escaped_r2" : "r2";
  std::string out = fmt::format(
      "    const REAL level = select((REAL)(0.0f), (REAL)(q[{}]), late);\n    const REAL outer = "
      "{}_distance({}, dr, "
      "level);\n",
      leaf_slot::level, form, square);
  if (variant_ != Variant::two_sided) return out + "    const REAL found = outer;\n";
  return out +
         fmt::format("    const REAL found = select(outer, -real_max(inner, (REAL)(0.0f)) * q[{}], alive);\n",
                     leaf_slot::inside_safety);
}

std::string LeafEmitter::folded_distance(std::string* gradient) {
  const Section& s = lowered_.back().finish;
  std::vector<NodeId> outputs{s.distance};
  if (variant_ == Variant::sample) outputs.insert(outputs.end(), s.gradient.begin(), s.gradient.end());
  GraphPrinter print = printer(lowered_.size() - 1, s, outputs, "f");
  std::string out = print.remaining_statements();
  if (variant_ == Variant::sample)
    *gradient = fmt::format("real3({}, {}, {})", print.text(s.gradient[0]), print.text(s.gradient[1]),
                            print.text(s.gradient[2]));
  return out +
         fmt::format("    const REAL found = {} / real_max(dr, (REAL)(1e-30f));\n", print.text(s.distance));
}

std::string LeafEmitter::iterated() {
  std::string out = start() + loop();
  std::string gradient = "real3(g0, g1, g2)";
  if (jacobian_) out += derivative_from_jacobian();
  if (variant_ == Variant::sample && escapes()) out += gradient_of_length();
  out += escapes() ? escape_distance() : folded_distance(&gradient);
  const std::string distance = fmt::format("finite_distance(found * q[{}])", leaf_slot::safety);
  if (variant_ != Variant::sample) return out + "    return " + distance + ";\n";
  const std::string rest =
      bails_out()
          ? fmt::format(
                " + real_sqrt(clamp(q[{}] / real_max(r2, (REAL)(1e-30f)), (REAL)(0.0f), (REAL)(1.0f)))",
                leaf_slot::bailout)
          : "";
  return out +
         fmt::format(
             "    const SdfSample s = {{{}, {}, real_sqrt(point), plane, axis, count{}}};\n    return s;\n",
             distance, gradient, rest);
}

LeafCode leaf_code(const FormulaField& field) {
  check(field);
  LeafCode code;
  using Variant = LeafEmitter::Variant;
  for (const Variant variant : {Variant::distance, Variant::two_sided, Variant::sample})
    code.functions += LeafEmitter(field, variant).function();
  const double inside = std::min(field.bailout, field.steps.back().definition.inside_radius);
  const FormulaDefinition& last = field.steps.back().definition;
  const double level = last.estimate == EscapeEstimate::logarithmic
                           ? 2 * std::log(std::max(field.bailout, 1e-3))
                           : field.bailout;
  for (const double value : {double(field.iterations), field.bailout * field.bailout, inside, field.safety,
                             last.inside_safety, level})
    code.parameters.push_back(value);
  for (const FormulaStep& step : field.steps)
    for (const double value : step.values) code.parameters.push_back(value);
  return code;
}

}  // namespace sundog
