// Emits a leaf's distance from the end of its orbit, or from its direct formula. See sdf_leaf.h.
#include "compile/fields/sdf_leaf.h"

#include <algorithm>
#include <cmath>

#include "compile/fields/held_bailout.h"
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

FieldCode LeafEmitter::function() {
  if (last_->kind == FormulaKind::direct)
    direct();
  else
    iterated();
  return std::move(code_);
}

void LeafEmitter::direct() {
  const Section& s = lowered_[0].finish;
  std::vector<NodeId> outputs{s.distance};
  if (is_sample()) outputs.insert(outputs.end(), s.gradient.begin(), s.gradient.end());
  GraphWriter write = writer(0, s, outputs, "f");
  write.write_rest();
  const Operand scaled =
      code_.define("scaled", FIELD_MULTIPLY, {write.value(s.distance), slot(leaf_slot::safety)});
  const Operand distance = code_.define("distance", FIELD_FINITE, {scaled});
  if (!is_sample()) return code_.set_result(distance);
  // The gradient of the returned distance; for a normalised formula, to first order about the surface.
  Operands parts;
  for (const NodeId id : s.gradient) parts.push_back(write.value(id));
  Operand gradient = code_.assemble("gradient", FieldType::point, parts);
  if (last_->normalize) gradient = code_.define("unit", FIELD_UNIT, {gradient});
  gradient = code_.define("slopes", FIELD_SCALE, {gradient, slot(leaf_slot::safety)});
  const Operand p = FieldCode::point();
  const Operands xyz{p.coordinate(0), p.coordinate(1), p.coordinate(2)};
  const Operand r2 = code_.define("r2", FIELD_SQUARE_LENGTH3, xyz);
  Operands sizes;
  for (const Operand& x : xyz) sizes.push_back(code_.define("size", FIELD_ABSOLUTE, {x}));
  const Operand of_yz = code_.define("least", FIELD_MINIMUM, {sizes[1], sizes[2]});
  const Operand plane = code_.define("plane", FIELD_MINIMUM, {sizes[0], of_yz});
  const Operand point = code_.define("point", FIELD_SQUARE_ROOT, {r2});
  const Operand axis = code_.define("axis", FIELD_AXIS_DISTANCE, xyz);
  code_.set_result(code_.assemble("s", FieldType::sample,
                                  {distance, gradient.coordinate(0), gradient.coordinate(1),
                                   gradient.coordinate(2), point, plane, axis, Operand::literal(0)}));
}

std::array<Operand, 3> LeafEmitter::gradient_of_length() {
  std::array<Operand, 3> gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t last = components() - 1;
    Operand sum = code_.define("part", FIELD_MULTIPLY, {z_[last], t_[last * 3 + axis]});
    for (std::size_t i = last; i-- > 0;)
      sum = code_.define("part", FIELD_FMA, {z_[i], t_[i * 3 + axis], sum});
    gradient[axis] = sum;
  }
  return gradient;
}

Operand LeafEmitter::escape_distance() {
  const Operand zero = Operand::literal(0);
  const Operand level = code_.define("level", FIELD_CHOOSE, {zero, slot(leaf_slot::level), late_});
  const FieldOp form = last_->estimate == EscapeEstimate::logarithmic ? FIELD_LOGARITHMIC : FIELD_LINEAR;
  const Operand outer = code_.define("outer", form, {latched() ? escaped_r2_ : r2_, dr_, level});
  if (variant_ != Variant::two_sided) return outer;
  const Operand room = code_.define("room", FIELD_MAXIMUM, {inner_, zero});
  const Operand below = code_.define("depth", FIELD_NEGATE, {room});
  const Operand depth = code_.define("depth", FIELD_MULTIPLY, {below, slot(leaf_slot::inside_safety)});
  return code_.define("found", FIELD_CHOOSE, {outer, depth, alive_});
}

Operand LeafEmitter::folded_distance(std::array<Operand, 3>* gradient) {
  const Section& s = lowered_.back().finish;
  std::vector<NodeId> outputs{s.distance};
  if (is_sample()) outputs.insert(outputs.end(), s.gradient.begin(), s.gradient.end());
  GraphWriter write = writer(lowered_.size() - 1, s, outputs, "f");
  write.write_rest();
  if (is_sample())
    for (std::size_t axis = 0; axis < 3; ++axis) (*gradient)[axis] = write.value(s.gradient[axis]);
  const Operand slope = code_.define("slope", FIELD_MAXIMUM, {dr_, Operand::literal(1e-30f)});
  return code_.define("found", FIELD_DIVIDE, {write.value(s.distance), slope});
}

void LeafEmitter::iterated() {
  start();
  loop();
  std::array<Operand, 3> gradient;
  if (jacobian_) dr_ = derivative_from_jacobian();
  if (is_sample() && escapes()) gradient = gradient_of_length();
  const Operand found = escapes() ? escape_distance() : folded_distance(&gradient);
  const Operand scaled = code_.define("scaled", FIELD_MULTIPLY, {found, slot(leaf_slot::safety)});
  const Operand distance = code_.define("distance", FIELD_FINITE, {scaled});
  if (!is_sample()) return code_.set_result(distance);
  Operand count = count_;
  if (bails_out()) {
    const Operand square = code_.define("square", FIELD_MAXIMUM, {r2_, Operand::literal(1e-30f)});
    const Operand share = code_.define("share", FIELD_DIVIDE, {slot(leaf_slot::bailout), square});
    const Operand within = code_.define("within", FIELD_CLAMPED, {share});
    const Operand rest = code_.define("rest", FIELD_SQUARE_ROOT, {within});
    count = code_.define("iterations_to_escape", FIELD_ADD, {count_, rest});
  }
  const Operand point = code_.define("nearest", FIELD_SQUARE_ROOT, {point_});
  code_.set_result(
      code_.assemble("s", FieldType::sample,
                     {distance, gradient[0], gradient[1], gradient[2], point, plane_, axis_, count}));
}

LeafCode leaf_code(const FormulaField& field) {
  check(field);
  FormulaField held = field;
  held.bailout = held_bailout(field);
  const double inside = std::min(held.bailout, field.steps.back().definition.inside_radius);
  const FormulaDefinition& last = field.steps.back().definition;
  const double level = last.estimate == EscapeEstimate::logarithmic
                           ? 2 * std::log(std::max(held.bailout, 1e-3))
                           : held.bailout;
  LeafTable table{{double(field.iterations), held.bailout * held.bailout, inside, field.safety,
                   last.inside_safety, level},
                  {}};
  for (const FormulaStep& step : field.steps)
    table.values.insert(table.values.end(), step.values.begin(), step.values.end());
  LeafCode code;
  using Variant = LeafEmitter::Variant;
  for (const Variant variant : {Variant::distance, Variant::two_sided, Variant::sample})
    code.functions[static_cast<std::size_t>(variant)] =
        std::make_shared<const FieldCode>(LeafEmitter(held, variant, table).function());
  code.parameters = std::move(table.values);
  return code;
}

}  // namespace sundog
