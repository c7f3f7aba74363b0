#include "compile/sdf_leaf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compile/sdf_emit.h"
#include "scene/formula/lower.h"

namespace sundog {
namespace {

namespace in = formula_input;

// The table of a leaf: these, then the parameters of its steps in order.
constexpr int iterations_slot = 0, bailout_slot = 1, inside_slot = 2, safety_slot = 3, inside_safety_slot = 4,
              level_slot = 5, first_parameter_slot = 6;

enum class Variant { distance, two_sided, sample };

const char* const components[4] = {"zx", "zy", "zz", "zw"};

class LeafEmitter {
 public:
  LeafEmitter(const FormulaField& field, Variant variant) : field_(field), variant_(variant) {
    int slot = first_parameter_slot;
    for (const FormulaStep& step : field.steps) {
      lowered_.push_back(
          lower(step.definition, step.values, lowered_.empty() ? nullptr : &lowered_[0].start));
      slots_.push_back(slot);
      slot += static_cast<int>(step.values.size());
    }
    for (const LoweredFormula& f : lowered_) jacobian_ |= f.jacobian;
    last_ = &field.steps.back().definition;
    size_ = lowered_.front().size;
    tangents_ = jacobian_ || variant == Variant::sample;
  }

  std::string function() {
    static const char* const names[] = {"distance", "signed", "sample"};
    const bool sample = variant_ == Variant::sample;
    std::string out =
        fmt::format("static inline {} NAME_{}(REAL3 p, MASK active, __global const float* restrict q) {{\n",
                    sample ? "SdfSample" : "REAL", names[static_cast<int>(variant_)]);
    out += last_->kind == FormulaKind::direct ? direct() : iterated();
    return out + "}\n\n";
  }

 private:
  bool escapes() const { return last_->kind == FormulaKind::escape; }
  bool bails_out() const { return escapes() || field_.bailout > 0; }
  bool running() const { return !jacobian_; }

  std::string input(std::size_t step, int index) const {
    if (index >= in::parameter) return fmt::format("(REAL)(q[{}])", slots_[step] + index - in::parameter);
    if (index >= in::tangent_c) return fmt::format("c_t{}", index - in::tangent_c);
    if (index >= in::tangent_z) return fmt::format("t{}", index - in::tangent_z);
    if (index >= in::c && index < in::c + 4) return fmt::format("c{}", "xyzw"[index - in::c]);
    if (index >= in::z && index < in::z + 4) return components[index - in::z];
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
  GraphPrinter printer(std::size_t step, const Section& section, std::vector<NodeId> outputs,
                       const char* prefix) const {
    return {section.graph, std::move(outputs), fmt::format("{}{}_", prefix, step),
            [this, step](int index) { return input(step, index); }};
  }
  std::string square() const {
    return size_ == 4 ? "square_length4(zx, zy, zz, zw)" : "square_length3(zx, zy, zz)";
  }

  std::string direct() {
    const Section& s = lowered_[0].finish;
    std::vector<NodeId> outputs{s.distance};
    const bool sample = variant_ == Variant::sample;
    if (sample) outputs.insert(outputs.end(), s.gradient.begin(), s.gradient.end());
    GraphPrinter print = printer(0, s, outputs, "f");
    std::string out = print.remaining_statements();
    const std::string distance = fmt::format("{} * q[{}]", print.text(s.distance), safety_slot);
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
        distance, last_->normalize ? "unit3(" + gradient + ")" : gradient, safety_slot);
    return out;
  }

  std::string start() {
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
      out += fmt::format("    REAL {} = {};\n", components[i], print.text(s.z[i]));
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

  std::string assign(const std::string& name, const std::string& value) const {
    if (!bails_out()) return fmt::format("    {} = {};\n", name, value);
    return fmt::format("    {0} = select({0}, {1}, alive);\n", name, value);
  }

  struct MapCode {
    std::string before, inside;
  };
  MapCode map(std::size_t step) {
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
    std::string copies;
    for (std::size_t i = 0; i < s.z.size(); ++i)
      code.inside += fmt::format("    const REAL new{}_{} = {};\n", step, components[i], print.text(s.z[i]));
    if (running()) code.inside += assign("dr", print.text(s.derivative));
    for (std::size_t i = 0; i < s.z.size(); ++i) {
      const std::string value = fmt::format("new{}_{}", step, components[i]);
      code.inside +=
          latched() ? fmt::format("    {} = {};\n", components[i], value) : assign(components[i], value);
    }
    if (tangents_)
      for (std::size_t i = 0; i < s.z.size() * 3; ++i)
        code.inside += assign(fmt::format("t{}", i), fmt::format("n{}_{}", step, i));
    return code;
  }

  /// One iteration: the only step, or the step whose turn it is.
  MapCode iteration() {
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
      code.inside +=
          (last ? "    {\n" : fmt::format("    if (turn < {}u) {{\n", end)) + part.inside + "    }";
      code.inside += last ? "\n" : " else\n";
    }
    return code;
  }

  /// The gradient of |z| times |z|: J^T z.
  std::string gradient_of_length() const {
    std::string out;
    for (int axis = 0; axis < 3; ++axis) {
      std::string sum = fmt::format("{} * t{}", components[size_ - 1], (size_ - 1) * 3 + axis);
      for (int i = size_ - 2; i >= 0; --i)
        sum = fmt::format("fma({}, t{}, {})", components[i], i * 3 + axis, sum);
      out += fmt::format("    const REAL g{} = {};\n", axis, sum);
    }
    return out;
  }
  /// dr from the Jacobian: the most that lengths grow in any direction.
  std::string derivative_from_jacobian() const {
    std::string rows;
    for (int i = 0; i < 4; ++i)
      rows += fmt::format("{}real3({})", i ? ", " : "",
                          i < size_ ? fmt::format("t{}, t{}, t{}", i * 3, i * 3 + 1, i * 3 + 2)
                                    : "(REAL)(0.0f), (REAL)(0.0f), (REAL)(0.0f)");
    return fmt::format("    const REAL dr = stretch_of({});\n", rows);
  }

  std::string inner_distance() const {
    std::string out = jacobian_ ? "    {\n" + derivative_from_jacobian() : "    {\n";
    return out + fmt::format(
                     "    const REAL room = (q[{}] - real_sqrt(r2)) / real_max(dr, (REAL)(1e-30f));\n"
                     "    inner = select(inner, real_min(room, inner), alive);\n    }}\n",
                     inside_slot);
  }

  std::string traps() const {
    std::string out = "    point = select(point, real_min(r2, point), alive);\n";
    out +=
        "    plane = select(plane, real_min(real_min(fabs(zx), real_min(fabs(zy), fabs(zz))), plane), "
        "alive);\n";
    out += "    axis = select(axis, real_min(axis_distance(zx, zy, zz), axis), alive);\n";
    return out + "    count = select(count, count + 1.0f, alive);\n";
  }

  /// Only |z| and its derivative at the escape are wanted: z itself may run on.
  bool latched() const { return variant_ == Variant::distance && escapes() && running(); }

  std::string latched_loop() {
    const std::string look = fmt::format(
        "r2 = {};\n    escaped_r2 = select(escaped_r2, r2, alive);\n    alive &= MASK_OF(r2 < q[{}]);\n",
        square(), bailout_slot);
    const MapCode code = iteration();
    return fmt::format(
        "    REAL r2 = (REAL)(0.0f), escaped_r2 = r2;\n    MASK alive = active;\n{}"
        "    const u32 iterations = (u32)q[{}];\n    for (u32 i = 0; i < iterations; ++i) {{\n    {}"
        "    if (!any_lane(alive)) break;\n{}    }}\n    const MASK late = alive;\n    {}",
        code.before, iterations_slot, look, code.inside, look);
  }

  std::string loop() {
    if (latched()) return latched_loop();
    const MapCode code = iteration();
    std::string out = "    REAL r2 = " + square() + ";\n";
    out += bails_out() ? fmt::format("    MASK alive = active & MASK_OF(r2 < q[{}]);\n", bailout_slot)
                       : "    const MASK alive = active;\n";
    if (variant_ == Variant::two_sided && escapes())
      out += "    REAL inner = (REAL)(1e30f);\n" + inner_distance();
    if (variant_ == Variant::sample)
      out += "    REAL point = (REAL)(1e30f), plane = point, axis = point, count = (REAL)(0.0f);\n";
    out += code.before;
    if (escapes()) out += "    MASK entered = alive;  // the last iteration\n";
    out += fmt::format(
        "    const u32 iterations = (u32)q[{}];\n    u32 i = 0;\n    for (; i < iterations; ++i) {{\n",
        iterations_slot);
    if (bails_out()) out += "    if (!any_lane(alive)) break;\n";
    out += code.inside + "    r2 = " + square() + ";\n";
    if (variant_ == Variant::sample) out += traps();
    if (variant_ == Variant::two_sided && escapes()) out += inner_distance();
    if (escapes()) out += "    entered = alive;\n";
    if (bails_out()) out += fmt::format("    alive &= MASK_OF(r2 < q[{}]);\n", bailout_slot);
    out += "    }\n";
    return escapes() ? out + "    const MASK late = i == iterations ? entered : NO_LANES;\n" : out;
  }

  /// Distance of an orbit that escaped or was ended; one that stays is inside, as deep as `inner`.
  std::string escape_distance() const {
    const char* form = last_->estimate == EscapeEstimate::logarithmic ? "logarithmic" : "linear";
    const char* square = latched() ? "escaped_r2" : "r2";
    std::string out = fmt::format(
        "    const REAL level = select((REAL)(0.0f), (REAL)(q[{}]), late);\n    const REAL outer = "
        "{}_distance({}, dr, "
        "level);\n",
        level_slot, form, square);
    if (variant_ != Variant::two_sided) return out + "    const REAL found = outer;\n";
    return out + fmt::format(
                     "    const REAL found = select(outer, -real_max(inner, (REAL)(0.0f)) * q[{}], alive);\n",
                     inside_safety_slot);
  }

  std::string folded_distance(std::string* gradient) {
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

  std::string iterated() {
    std::string out = start() + loop();
    std::string gradient = "real3(g0, g1, g2)";
    if (jacobian_) out += derivative_from_jacobian();
    if (variant_ == Variant::sample && escapes()) out += gradient_of_length();
    out += escapes() ? escape_distance() : folded_distance(&gradient);
    const std::string distance = fmt::format("finite_distance(found * q[{}])", safety_slot);
    if (variant_ != Variant::sample) return out + "    return " + distance + ";\n";
    const std::string rest =
        bails_out()
            ? fmt::format(
                  " + real_sqrt(clamp(q[{}] / real_max(r2, (REAL)(1e-30f)), (REAL)(0.0f), (REAL)(1.0f)))",
                  bailout_slot)
            : "";
    return out +
           fmt::format(
               "    const SdfSample s = {{{}, {}, real_sqrt(point), plane, axis, count{}}};\n    return s;\n",
               distance, gradient, rest);
  }

  const FormulaField& field_;
  Variant variant_;
  std::vector<LoweredFormula> lowered_;
  std::vector<int> slots_;
  const FormulaDefinition* last_ = nullptr;
  int size_ = 3;
  bool jacobian_ = false, tangents_ = false;
};

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

LeafCode leaf_code(const FormulaField& field) {
  check(field);
  LeafCode code;
  for (const Variant variant : {Variant::distance, Variant::two_sided, Variant::sample})
    code.functions += LeafEmitter(field, variant).function();
  const double inside = std::min(field.bailout, field.steps.back().definition.inside_radius);
  const FormulaDefinition& last = field.steps.back().definition;
  const double level = last.estimate == EscapeEstimate::logarithmic
                           ? 2 * std::log(std::max(field.bailout, 1e-3))
                           : field.bailout;
  for (const double value : {double(field.iterations), field.bailout * field.bailout, inside, field.safety,
                             last.inside_safety, level})
    code.parameters.push_back(static_cast<float>(value));
  for (const FormulaStep& step : field.steps)
    for (const double value : step.values) code.parameters.push_back(static_cast<float>(value));
  return code;
}

}  // namespace sundog
