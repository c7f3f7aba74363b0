// Emits a leaf's orbit: its start, one iteration, and the loop. See sdf_leaf_emitter.h.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "compile/fields/sdf_leaf_emitter.h"

namespace sundog {

namespace in = formula_input;

namespace {

constexpr const char* z_names[4] = {"zx", "zy", "zz", "zw"};

bool changes_in_orbit(int index) {
  return (index >= in::z && index < in::z + 4) || index == in::derivative || index == in::iteration ||
         index == in::square || (index >= in::tangent_z && index < in::tangent_c);
}

}  // namespace

LeafEmitter::LeafEmitter(const FormulaField& field, Variant variant, LeafTable& table)
    : field_(field), variant_(variant), table_(table) {
  int slot = leaf_slot::first_parameter;
  for (const FormulaStep& step : field.steps) {
    lowered_.push_back(lower(step.definition, step.values, lowered_.empty() ? nullptr : &lowered_[0].start));
    slots_.push_back(slot);
    slot += static_cast<int>(step.values.size());
  }
  for (const LoweredFormula& f : lowered_) jacobian_ |= f.jacobian;
  last_ = &field.steps.back().definition;
  size_ = lowered_.front().size;
  tangents_ = jacobian_ || variant == Variant::sample;
}

Operand LeafEmitter::input(std::size_t step, int index) {
  const auto from = [index](const auto& values, int first) {
    return values[static_cast<std::size_t>(index - first)];
  };
  if (index >= in::parameter) return slot(slots_[step] + index - in::parameter);
  if (index >= in::tangent_c) return from(c_t_, in::tangent_c);
  if (index >= in::tangent_z) return from(t_, in::tangent_z);
  if (index >= in::c && index < in::c + 4) return from(c_, in::c);
  if (index >= in::z && index < in::z + 4) return from(z_, in::z);
  switch (index) {
    case in::derivative:
      return dr_;
    case in::c_slope:
      return c_slope_;
    case in::iteration:
      return code_.define("iteration", FIELD_ITERATION, {});
    case in::square:
      return r2_;
    default:
      return FieldCode::point().coordinate(index);
  }
}

/// Adds a number that depends on the step's parameters alone to the table, if new, and returns its entry.
Operand LeafEmitter::known(std::size_t step, char section, const Graph& graph, NodeId id) {
  const auto [place, is_new] = table_.places.try_emplace({step, section, id}, table_.values.size());
  if (is_new) {
    const auto parameter = [&](int index) {
      return field_.steps[step].values[static_cast<std::size_t>(index - in::parameter)];
    };
    const double value = evaluate(graph, std::array{id}, parameter)[0],
                 most = std::numeric_limits<float>::max();
    table_.values.push_back(std::clamp(value, -most, most));
  }
  return Operand::table(place->second);
}

GraphWriter LeafEmitter::writer(std::size_t step, const Section& section, std::vector<NodeId> outputs,
                                const char* prefix) {
  return {code_,
          section.graph,
          std::move(outputs),
          fmt::format("{}{}_", prefix, step),
          [this, step](int index) { return input(step, index); },
          [this, step, prefix, &section](NodeId id) { return known(step, *prefix, section.graph, id); }};
}

void LeafEmitter::square(const Operand& r2) {
  if (size_ == 4)
    code_.assign(r2, FIELD_SQUARE_LENGTH4, {z_[0], z_[1], z_[2], z_[3]});
  else
    code_.assign(r2, FIELD_SQUARE_LENGTH3, {z_[0], z_[1], z_[2]});
}

Operand LeafEmitter::below_bailout() {
  return code_.define("below", FIELD_LESS, {r2_, slot(leaf_slot::bailout)});
}

void LeafEmitter::start() {
  const Section& s = lowered_[0].start;
  std::vector<NodeId> outputs = s.z;
  outputs.insert(outputs.end(), s.c.begin(), s.c.end());
  if (running()) outputs.push_back(s.derivative);
  const bool c_slope = running() && s.c_slope != no_node && !s.graph.is_constant(s.c_slope);
  if (c_slope) outputs.push_back(s.c_slope);
  if (tangents_)
    for (const auto* rows : {&s.z_tangents, &s.c_tangents})
      for (const auto& row : *rows) outputs.insert(outputs.end(), row.begin(), row.end());
  GraphWriter write = writer(0, s, outputs, "s");
  write.write_rest();
  for (std::size_t i = 0; i < s.z.size(); ++i) {
    z_[i] = code_.declare(z_names[i], FIELD_COPY, {write.value(s.z[i])});
    c_[i] = write.value(s.c[i]);
  }
  if (running()) dr_ = code_.declare("dr", FIELD_COPY, {write.value(s.derivative)});
  if (c_slope) c_slope_ = write.value(s.c_slope);
  if (!tangents_) return;
  for (std::size_t i = 0; i < s.z.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at = i * 3 + axis;
      t_[at] = code_.declare(fmt::format("t{}", at), FIELD_COPY, {write.value(s.z_tangents[i][axis])});
      c_t_[at] = write.value(s.c_tangents[i][axis]);
    }
}

void LeafEmitter::assign(const Operand& variable, const Operand& value) {
  if (bails_out())
    code_.assign(variable, FIELD_CHOOSE, {variable, value, alive_});
  else
    code_.assign(variable, FIELD_COPY, {value});
}

GraphWriter LeafEmitter::map_writer(std::size_t step) {
  const Section& s = lowered_[step].map;
  std::vector<NodeId> outputs = s.z;
  if (running()) outputs.push_back(s.derivative);
  if (tangents_)
    for (const auto& row : s.z_tangents) outputs.insert(outputs.end(), row.begin(), row.end());
  return writer(step, s, outputs, "m");
}

void LeafEmitter::map(std::size_t step, GraphWriter& write) {
  const Section& s = lowered_[step].map;
  write.write_rest();
  // All new values must be computed before the first is assigned, so variables are copied.
  const auto kept = [&](const std::string& name, NodeId id) {
    const Operand value = write.value(id);
    return s.graph[id].op == Op::input ? code_.define(name, FIELD_COPY, {value}) : value;
  };
  std::vector<Operand> tangents, z;
  if (tangents_)
    for (std::size_t i = 0; i < s.z.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        tangents.push_back(kept(fmt::format("n{}_{}", step, i * 3 + axis), s.z_tangents[i][axis]));
  for (std::size_t i = 0; i < s.z.size(); ++i)
    z.push_back(kept(fmt::format("new{}_{}", step, z_names[i]), s.z[i]));
  if (running()) assign(dr_, write.value(s.derivative));
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (latched())
      code_.assign(z_[i], FIELD_COPY, {z[i]});
    else
      assign(z_[i], z[i]);
  }
  for (std::size_t i = 0; i < tangents.size(); ++i) assign(t_[i], tangents[i]);
}

std::vector<GraphWriter> LeafEmitter::begin_maps() {
  std::vector<GraphWriter> maps;
  for (std::size_t step = 0; step < lowered_.size(); ++step) {
    maps.push_back(map_writer(step));
    maps.back().write_invariants(changes_in_orbit);
  }
  return maps;
}

void LeafEmitter::iteration(std::vector<GraphWriter>& maps) {
  if (lowered_.size() == 1) return map(0, maps[0]);
  std::size_t total = 0, end = 0;
  for (const FormulaStep& step : field_.steps) total += static_cast<std::size_t>(step.times);
  for (std::size_t step = 0; step < lowered_.size(); ++step) {
    end += static_cast<std::size_t>(field_.steps[step].times);
    if (step == 0)
      code_.begin_turn(total, end);
    else
      code_.next_turn(step + 1 == lowered_.size() ? 0 : end);
    map(step, maps[step]);
  }
  code_.end();
}

Operand LeafEmitter::derivative_from_jacobian() {
  Operands rows;
  const Operand zero = Operand::literal(0);
  for (std::size_t i = 0; i < 4; ++i)
    rows.push_back(code_.assemble(
        "row", FieldType::point,
        i < components() ? Operands{t_[i * 3], t_[i * 3 + 1], t_[i * 3 + 2]} : Operands{zero, zero, zero}));
  return code_.define("dr", FIELD_STRETCH, rows);
}

void LeafEmitter::inner_distance() {
  const Operand dr = jacobian_ ? derivative_from_jacobian() : dr_;
  const Operand root = code_.define("root", FIELD_SQUARE_ROOT, {r2_});
  const Operand apart = code_.define("apart", FIELD_SUBTRACT, {slot(leaf_slot::inside), root});
  const Operand slope = code_.define("slope", FIELD_MAXIMUM, {dr, Operand::literal(1e-30f)});
  const Operand room = code_.define("room", FIELD_DIVIDE, {apart, slope});
  const Operand least = code_.define("least", FIELD_MINIMUM, {room, inner_});
  code_.assign(inner_, FIELD_CHOOSE, {inner_, least, alive_});
}

void LeafEmitter::traps() {
  const auto keep = [&](const Operand& trap, const Operand& value) {
    code_.assign(trap, FIELD_CHOOSE, {trap, value, alive_});
  };
  const auto least = [&](const Operand& a, const Operand& b) {
    return code_.define("least", FIELD_MINIMUM, {a, b});
  };
  keep(point_, least(r2_, point_));
  Operands sizes;
  for (std::size_t i = 0; i < 3; ++i) sizes.push_back(code_.define("size", FIELD_ABSOLUTE, {z_[i]}));
  const Operand of_yz = least(sizes[1], sizes[2]), of_all = least(sizes[0], of_yz);
  keep(plane_, least(of_all, plane_));
  const Operand axis = code_.define("to_axis", FIELD_AXIS_DISTANCE, {z_[0], z_[1], z_[2]});
  keep(axis_, least(axis, axis_));
  keep(count_, code_.define("more", FIELD_ADD, {count_, Operand::literal(1)}));
}

void LeafEmitter::latched_look() {
  square(r2_);
  code_.assign(escaped_r2_, FIELD_CHOOSE, {escaped_r2_, r2_, alive_});
  const Operand below = below_bailout();
  code_.assign(alive_, FIELD_BOTH, {alive_, below});
}

void LeafEmitter::latched_loop() {
  r2_ = code_.declare("r2", FIELD_COPY, {Operand::literal(0)});
  escaped_r2_ = code_.declare("escaped_r2", FIELD_COPY, {Operand::literal(0)});
  alive_ = code_.declare("alive", FIELD_COPY_MASK, {FieldCode::active()});
  std::vector<GraphWriter> maps = begin_maps();
  code_.begin_iterations(leaf_slot::iterations);
  latched_look();
  code_.leave_if_none(alive_);
  iteration(maps);
  code_.end();
  late_ = code_.define("late", FIELD_COPY_MASK, {alive_});
  latched_look();
}

void LeafEmitter::loop() {
  if (latched()) return latched_loop();
  r2_ = code_.declare("r2", FIELD_COPY, {Operand::literal(0)});
  square(r2_);
  alive_ = code_.declare("alive", FIELD_COPY_MASK, {FieldCode::active()});
  if (bails_out()) {
    const Operand below = below_bailout();
    code_.assign(alive_, FIELD_BOTH, {alive_, below});
  }
  const bool has_inner = variant_ == Variant::two_sided && escapes();
  if (has_inner) {
    inner_ = code_.declare("inner", FIELD_COPY, {Operand::literal(1e30f)});
    inner_distance();
  }
  if (is_sample()) {
    for (auto [trap, name] : {std::pair{&point_, "point"}, {&plane_, "plane"}, {&axis_, "axis"}})
      *trap = code_.declare(name, FIELD_COPY, {Operand::literal(1e30f)});
    count_ = code_.declare("count", FIELD_COPY, {Operand::literal(0)});
  }
  std::vector<GraphWriter> maps = begin_maps();
  if (escapes()) entered_ = code_.declare("entered", FIELD_COPY_MASK, {alive_});  // in the last iteration
  code_.begin_iterations(leaf_slot::iterations);
  if (bails_out()) code_.leave_if_none(alive_);
  iteration(maps);
  square(r2_);
  if (is_sample()) traps();
  if (has_inner) inner_distance();
  if (escapes()) code_.assign(entered_, FIELD_COPY_MASK, {alive_});
  if (bails_out()) {
    const Operand below = below_bailout();
    code_.assign(alive_, FIELD_BOTH, {alive_, below});
  }
  code_.end();
  if (escapes()) late_ = code_.define("late", FIELD_LATE, {entered_}, leaf_slot::iterations);
}

}  // namespace sundog
