// A leaf's orbit as code: before the first iteration, one iteration, the loop. See sdf_leaf_emitter.h.
#include <fmt/format.h>

#include "compile/fields/sdf_leaf_emitter.h"

namespace sundog {

namespace in = formula_input;

LeafEmitter::LeafEmitter(const FormulaField& field, Variant variant) : field_(field), variant_(variant) {
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

std::string LeafEmitter::input(std::size_t step, int index) const {
  if (index >= in::parameter) return fmt::format("(REAL)(q[{}])", slots_[step] + index - in::parameter);
  if (index >= in::tangent_c) return fmt::format("c_t{}", index - in::tangent_c);
  if (index >= in::tangent_z) return fmt::format("t{}", index - in::tangent_z);
  if (index >= in::c && index < in::c + 4) return fmt::format("c{}", "xyzw"[index - in::c]);
  if (index >= in::z && index < in::z + 4) return z_names[index - in::z];
  switch (index) {
    case in::derivative:
      return "dr";
    case in::c_slope:
      return "c_slope";
    case in::iteration:
      return "(REAL)((float)i)";
    case in::square:
      return "r2";
    default:
      return fmt::format("p.{}", "xyz"[index]);
  }
}

GraphPrinter LeafEmitter::printer(std::size_t step, const Section& section, std::vector<NodeId> outputs,
                                  const char* prefix) const {
  return {section.graph, std::move(outputs), fmt::format("{}{}_", prefix, step),
          [this, step](int index) { return input(step, index); }};
}

std::string LeafEmitter::square() const {
  return size_ == 4 ? "square_length4(zx, zy, zz, zw)" : "square_length3(zx, zy, zz)";
}

std::string LeafEmitter::start() {
  const Section& s = lowered_[0].start;
  std::vector<NodeId> outputs = s.z;
  outputs.insert(outputs.end(), s.c.begin(), s.c.end());
  if (running()) outputs.push_back(s.derivative);
  const bool c_slope = running() && s.c_slope != no_node && !s.graph.is_constant(s.c_slope);
  if (c_slope) outputs.push_back(s.c_slope);
  if (tangents_)
    for (const auto* rows : {&s.z_tangents, &s.c_tangents})
      for (const auto& row : *rows) outputs.insert(outputs.end(), row.begin(), row.end());
  GraphPrinter print = printer(0, s, outputs, "s");
  std::string out = print.remaining_statements();
  for (std::size_t i = 0; i < s.z.size(); ++i) {
    out += fmt::format("    REAL {} = {};\n", z_names[i], print.text(s.z[i]));
    out += fmt::format("    const REAL c{} = {};\n", "xyzw"[i], print.text(s.c[i]));
  }
  if (running()) out += fmt::format("    REAL dr = {};\n", print.text(s.derivative));
  if (c_slope) out += fmt::format("    const REAL c_slope = {};\n", print.text(s.c_slope));
  if (!tangents_) return out;
  for (std::size_t i = 0; i < s.z.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out += fmt::format("    REAL t{} = {};\n", i * 3 + axis, print.text(s.z_tangents[i][axis]));
      if (!s.graph.is_constant(s.c_tangents[i][axis]))
        out += fmt::format("    const REAL c_t{} = {};\n", i * 3 + axis, print.text(s.c_tangents[i][axis]));
    }
  return out;
}

std::string LeafEmitter::assign(const std::string& name, const std::string& value) const {
  if (!bails_out()) return fmt::format("    {} = {};\n", name, value);
  return fmt::format("    {0} = select({0}, {1}, alive);\n", name, value);
}

LeafEmitter::MapCode LeafEmitter::map(std::size_t step) {
  const Section& s = lowered_[step].map;
  std::vector<NodeId> outputs = s.z;
  if (running()) outputs.push_back(s.derivative);
  if (tangents_)
    for (const auto& row : s.z_tangents) outputs.insert(outputs.end(), row.begin(), row.end());
  GraphPrinter print = printer(step, s, outputs, "m");
  MapCode code;
  code.before = print.invariant_statements([](int index) {
    return (index >= in::z && index < in::z + 4) || index == in::derivative || index == in::iteration ||
           index == in::square || (index >= in::tangent_z && index < in::tangent_c);
  });
  code.inside = print.remaining_statements();
  if (tangents_)  // all new values are known before the first is set
    for (std::size_t i = 0; i < s.z.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        code.inside += fmt::format("    const REAL n{}_{} = {};\n", step, i * 3 + axis,
                                   print.text(s.z_tangents[i][axis]));
  for (std::size_t i = 0; i < s.z.size(); ++i)
    code.inside += fmt::format("    const REAL new{}_{} = {};\n", step, z_names[i], print.text(s.z[i]));
  if (running()) code.inside += assign("dr", print.text(s.derivative));
  for (std::size_t i = 0; i < s.z.size(); ++i) {
    const std::string value = fmt::format("new{}_{}", step, z_names[i]);
    code.inside += latched() ? fmt::format("    {} = {};\n", z_names[i], value) : assign(z_names[i], value);
  }
  if (tangents_)
    for (std::size_t i = 0; i < s.z.size() * 3; ++i)
      code.inside += assign(fmt::format("t{}", i), fmt::format("n{}_{}", step, i));
  return code;
}

LeafEmitter::MapCode LeafEmitter::iteration() {
  if (lowered_.size() == 1) return map(0);
  MapCode code;
  int total = 0;
  for (const FormulaStep& step : field_.steps) total += step.times;
  code.inside = fmt::format("    const u32 turn = i % {}u;\n", total);
  int end = 0;
  for (std::size_t step = 0; step < lowered_.size(); ++step) {
    const MapCode part = map(step);
    end += field_.steps[step].times;
    code.before += part.before;
    const bool last = step + 1 == lowered_.size();
    code.inside += (last ? "    {\n" : fmt::format("    if (turn < {}u) {{\n", end)) + part.inside + "    }";
    code.inside += last ? "\n" : " else\n";
  }
  return code;
}

std::string LeafEmitter::derivative_from_jacobian() const {
  std::string rows;
  for (int i = 0; i < 4; ++i)
    rows += fmt::format("{}real3({})", i ? ", " : "",
                        i < size_ ? fmt::format("t{}, t{}, t{}", i * 3, i * 3 + 1, i * 3 + 2)
                                  : "(REAL)(0.0f), (REAL)(0.0f), (REAL)(0.0f)");
  return fmt::format("    const REAL dr = stretch_of({});\n", rows);
}

std::string LeafEmitter::inner_distance() const {
  std::string out = jacobian_ ? "    {\n" + derivative_from_jacobian() : "    {\n";
  return out + fmt::format(
                   "    const REAL room = (q[{}] - real_sqrt(r2)) / real_max(dr, (REAL)(1e-30f));\n"
                   "    inner = select(inner, real_min(room, inner), alive);\n    }}\n",
                   leaf_slot::inside);
}

std::string LeafEmitter::traps() const {
  std::string out = "    point = select(point, real_min(r2, point), alive);\n";
  out +=
      "    plane = select(plane, real_min(real_min(fabs(zx), real_min(fabs(zy), fabs(zz))), plane), "
      "alive);\n";
  out += "    axis = select(axis, real_min(axis_distance(zx, zy, zz), axis), alive);\n";
  return out + "    count = select(count, count + 1.0f, alive);\n";
}

std::string LeafEmitter::latched_loop() {
  const std::string look = fmt::format(
      "r2 = {};\n    escaped_r2 = select(escaped_r2, r2, alive);\n    alive &= MASK_OF(r2 < q[{}]);\n",
      square(), leaf_slot::bailout);
  const MapCode code = iteration();
  return fmt::format(
      "    REAL r2 = (REAL)(0.0f), escaped_r2 = r2;\n    MASK alive = active;\n{}"
      "    const u32 iterations = (u32)q[{}];\n    for (u32 i = 0; i < iterations; ++i) {{\n    {}"
      "    if (!any_lane(alive)) break;\n{}    }}\n    const MASK late = alive;\n    {}",
      code.before, leaf_slot::iterations, look, code.inside, look);
}

std::string LeafEmitter::loop() {
  if (latched()) return latched_loop();
  const MapCode code = iteration();
  std::string out = "    REAL r2 = " + square() + ";\n";
  out += bails_out() ? fmt::format("    MASK alive = active & MASK_OF(r2 < q[{}]);\n", leaf_slot::bailout)
                     : "    const MASK alive = active;\n";
  if (variant_ == Variant::two_sided && escapes())
    out += "    REAL inner = (REAL)(1e30f);\n" + inner_distance();
  if (variant_ == Variant::sample)
    out += "    REAL point = (REAL)(1e30f), plane = point, axis = point, count = (REAL)(0.0f);\n";
  out += code.before;
  if (escapes()) out += "    MASK entered = alive;  // the last iteration\n";
  out += fmt::format(
      "    const u32 iterations = (u32)q[{}];\n    u32 i = 0;\n    for (; i < iterations; ++i) {{\n",
      leaf_slot::iterations);
  if (bails_out()) out += "    if (!any_lane(alive)) break;\n";
  out += code.inside + "    r2 = " + square() + ";\n";
  if (variant_ == Variant::sample) out += traps();
  if (variant_ == Variant::two_sided && escapes()) out += inner_distance();
  if (escapes()) out += "    entered = alive;\n";
  if (bails_out()) out += fmt::format("    alive &= MASK_OF(r2 < q[{}]);\n", leaf_slot::bailout);
  out += "    }\n";
  return escapes() ? out + "    const MASK late = i == iterations ? entered : NO_LANES;\n" : out;
}

}  // namespace sundog
