// Compiles each field's tree to calls of leaf functions and lib/sdf/compose.cl.
#include "compile/fields/sdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>

#include "compile/fields/field_program.h"
#include "compile/fields/sdf_deep.h"
#include "compile/fields/sdf_leaf.h"
#include "compile/fields/sdf_scale.h"

namespace sundog {
namespace {

constexpr const char* file_head = R"(// Written by the host for the fields of one scene.
#ifndef SUNDOG_GENERATED_SDF_CL
#define SUNDOG_GENERATED_SDF_CL
)";
constexpr const char* deep_head = "#include \"lib/sdf/deep_begin.h\"\n";
constexpr const char* compose_head = "#include \"lib/sdf/compose.cl\"\n\n";

class FieldsEmitter {
 public:
  CompiledFields run(std::span<const SdfDescription> fields) {
    if (!fields.empty()) table({0});  // offset of the programs
    for (const SdfDescription& field : fields) {
      SdfDescription leveled = field;
      level_scales(leveled.root);
      add_field(leveled);
      out_.fields.push_back(record(leveled));
    }
    const std::string code = compose_head + leaves_ + fields_;
    if (!fields.empty())
      out_.source = file_head + code + dispatch("sdf_", "__global const float* restrict") + "#endif\n";
    add_programs();
    return std::move(out_);
  }

  CompiledFields run_deep(std::span<const DeepField> fields) {
    table({0});  // no programs in double precision
    for (const DeepField& deep : fields) {
      SdfDescription field = deep.field;
      level_scales(field.root);
      add_field(field);
      field.lower -= deep.origin;
      field.upper -= deep.origin;
      if (field.sphere) *field.sphere -= glm::dvec4(deep.origin, 0);
      out_.fields.push_back(record(field));
    }
    std::size_t origins = out_.parameters.size();
    for (const DeepField& deep : fields) table({deep.origin.x, deep.origin.y, deep.origin.z});
    const std::string code = file_head + std::string(deep_head) + compose_head + leaves_ + fields_ +
                             dispatch("deep_", "SDF_TABLE");
    if (out_.parameters.size() % 2) table({0});
    out_.source = code +
                  fmt::format("#define SDF_DOUBLES_AT {}u\n#define SDF_ORIGINS {}u\n", out_.parameters.size(),
                              origins) +
                  "#include \"lib/sdf/deep_end.h\"\n" + shallow_functions() + "#endif\n";
    for (const double value : exact_) {
      float halves[2];
      std::memcpy(halves, &value, sizeof value);
      out_.parameters.insert(out_.parameters.end(), halves, halves + 2);
    }
    return std::move(out_);
  }

 private:
  struct Kind {
    FieldType type;
    const char* suffix;
  };
  static constexpr Kind kinds[4] = {{FieldType::real, "distance"},
                                    {FieldType::real, "signed"},
                                    {FieldType::sample, "sample"},
                                    {FieldType::real, "near"}};
  struct Leaf {
    std::string name;
    std::array<std::shared_ptr<const FieldCode>, 3> functions;
  };

  /// Appends the functions as programs for the kernels' interpreter.
  void add_programs() {
    const std::vector<u32> words = field_programs(codes_);
    if (words.empty()) return;
    out_.parameters[0] = std::bit_cast<float>(static_cast<u32>(out_.parameters.size()));
    for (const u32 word : words) out_.parameters.push_back(std::bit_cast<float>(word));
  }

  std::size_t table(const std::vector<double>& values) {
    const std::size_t first = out_.parameters.size();
    for (const double value : values) out_.parameters.push_back(static_cast<float>(value));
    exact_.insert(exact_.end(), values.begin(), values.end());
    return first;
  }

  /// Allocates parameters once for the three functions, in tree order.
  void place(const SdfNode& node, int depth = 1) {
    if (depth > SdfNode::max_depth)
      throw FormulaError(0, 0, fmt::format("fields nested deeper than {} levels", SdfNode::max_depth));
    switch (node.kind) {
      case SdfNode::Kind::formula:
        places_.push_back(place_leaf(node.formula));
        break;
      case SdfNode::Kind::transform:
        places_.push_back(place_transform(node));
        break;
      case SdfNode::Kind::native:
        places_.push_back(0);
        leaves_ += native_code(node.code, native_count_++);
        break;
      case SdfNode::Kind::repeat:
        places_.push_back(
            table({node.period.x, node.period.y, node.period.z, node.count.x, node.count.y, node.count.z}));
        break;
      case SdfNode::Kind::thicken:
      case SdfNode::Kind::shell:
        places_.push_back(table({node.amount}));
        break;
      default:
        places_.push_back(table({node.smooth}));
        break;
    }
    const bool is_leaf = node.kind == SdfNode::Kind::formula || node.kind == SdfNode::Kind::native;
    const std::size_t wanted = is_leaf ? 0 : is_joint(node) ? 2 : 1;
    if (node.children.size() < wanted || (wanted < 2 && node.children.size() != wanted))
      throw FormulaError(
          0, 0,
          fmt::format("a field's operation takes {} fields, found {}",
                      wanted == 2 ? "two or more" : std::to_string(wanted), node.children.size()));
    for (const SdfNode& child : node.children) place(child, depth + 1);
  }
  /// Wraps native code in functions; gradients use differences. #line makes build logs name its own lines.
  static std::string native_code(const std::string& code, std::size_t index) {
    return fmt::format(
        "static inline REAL native{0}(REAL3 p) {{\n#line 1 \"native code {0} of the scene\"\n{1}\n}}\n#line "
        "1 \"after native code {0}\"\n"
        "static inline SdfSample native{0}_sample(REAL3 p) {{\n  SdfSample s = no_sample();\n  s.distance = "
        "native{0}(p);\n  return s;\n}}\n\n",
        index, code);
  }
  static bool is_joint(const SdfNode& node) {
    return node.kind == SdfNode::Kind::unite || node.kind == SdfNode::Kind::intersect ||
           node.kind == SdfNode::Kind::subtract;
  }

  std::size_t place_leaf(const FormulaField& formula) {
    if (++leaf_count_ > SdfNode::max_formulas)
      throw FormulaError(0, 0, fmt::format("a scene may have {} formulas", SdfNode::max_formulas));
    LeafCode code = leaf_code(formula);
    std::string key;
    for (const auto& function : code.functions) key += function->text();
    auto [found, is_new] = leaf_names_.try_emplace(key, Leaf{fmt::format("leaf{}", leaf_names_.size()), {}});
    if (is_new) {
      found->second.functions = code.functions;
      for (std::size_t i = 0; i < code.functions.size(); ++i)
        leaves_ += function_text(kinds[i], found->second.name + "_", *code.functions[i]);
    }
    leaf_of_place_.push_back(found->second);
    return table(code.parameters);
  }
  static std::string function_text(const Kind& kind, const std::string& name, const FieldCode& code) {
    return fmt::format("static inline {} {}{}(REAL3 p, MASK active, SDF_TABLE q) {{\n{}}}\n\n",
                       type_name(kind.type), name, kind.suffix, code.text());
  }

  std::size_t place_transform(const SdfNode& node) {
    std::vector<double> values;
    for (int row = 0; row < 3; ++row)  // rows of the transpose are columns of the rotation
      for (int column = 0; column < 3; ++column) values.push_back(node.rotation[row][column]);
    values.insert(values.end(), {node.offset.x, node.offset.y, node.offset.z, node.scale, 1 / node.scale});
    return table(values);
  }

  void add_field(const SdfDescription& field) {
    places_.clear();
    const std::size_t first_native = native_count_;
    leaf_of_place_.clear();
    place(field.root);
    const std::size_t index = out_.fields.size();
    uneven_.push_back(is_uneven(field.root));
    codes_.emplace_back();
    for (int kind = 0; kind < (uneven_.back() ? 4 : 3); ++kind) {
      kind_ = kind;
      next_place_ = next_leaf_ = 0;
      next_native_ = first_native;
      code_ = {};
      code_.set_result(visit(field.root, FieldCode::point(), kind == 1));
      fields_ += function_text(kinds[kind], fmt::format("field{}_", index), code_);
      codes_.back().push_back(std::move(code_));
    }
  }

  bool samples() const { return kind_ == 2; }
  Operand define(FieldOp op, Operands operands, std::size_t number = 0) {
    return code_.define("v", op, std::move(operands), number);
  }

  /// Emits a node at point `p` and returns its value. `two_sided`: depths inside are needed.
  Operand visit(const SdfNode& node, const Operand& p, bool two_sided) {
    if (kind_ == 3 && is_smooth(node)) {
      kind_ = 2;
      const Operand sample = visit(node, p, two_sided);
      kind_ = 3;
      return define(FIELD_NEAR_DISTANCE, {sample});
    }
    const std::size_t q = places_[next_place_++];
    switch (node.kind) {
      case SdfNode::Kind::formula: {
        const std::size_t variant = samples() ? 2 : kind_ != 0 || two_sided ? 1 : 0;
        const Leaf& leaf = leaf_of_place_[next_leaf_++];
        return code_.call(fmt::format("{}_{}", leaf.name, kinds[variant].suffix), kinds[variant].type, p, q,
                          leaf.functions[variant]);
      }
      case SdfNode::Kind::native:
        return code_.call(fmt::format("native{}{}", next_native_++, samples() ? "_sample" : ""),
                          kinds[kind_].type, p, q, nullptr);
      case SdfNode::Kind::transform: {
        const Operand local = define(FIELD_INTO_CHILD, {p}, q);
        const Operand child = visit(node.children[0], local, two_sided);
        return define(samples() ? FIELD_OUT_OF_CHILD_SAMPLE : FIELD_OUT_OF_CHILD, {child}, q);
      }
      case SdfNode::Kind::repeat:
        return visit_repeat(node, p, q, two_sided);
      case SdfNode::Kind::thicken: {
        const Operand child = visit(node.children[0], p, two_sided);
        return define(samples() ? FIELD_THICKEN_SAMPLE : FIELD_THICKEN, {child}, q);
      }
      case SdfNode::Kind::shell: {
        const Operand child = visit(node.children[0], p, true);
        return define(samples() ? FIELD_SHELL_SAMPLE : FIELD_SHELL, {child}, q);
      }
      default:
        return visit_joint(node, p, q, two_sided);
    }
  }

  Operand visit_joint(const SdfNode& node, const Operand& p, std::size_t q, bool two_sided) {
    const bool subtract = node.kind == SdfNode::Kind::subtract;
    const FieldOp op = node.kind == SdfNode::Kind::unite ? (samples() ? FIELD_UNITE_SAMPLES : FIELD_UNITE)
                       : subtract ? (samples() ? FIELD_SUBTRACT_SAMPLES : FIELD_SUBTRACT_FROM)
                                  : (samples() ? FIELD_INTERSECT_SAMPLES : FIELD_INTERSECT);
    const bool rounded = node.smooth > 0;  // a rounded joint needs depths near its seam
    Operand value = visit(node.children[0], p, two_sided || rounded);
    for (std::size_t i = 1; i < node.children.size(); ++i) {
      const Operand other = visit(node.children[i], p, two_sided || subtract || rounded);
      value = define(op, {value, other}, q);
    }
    return value;
  }

  Operand visit_repeat(const SdfNode& node, const Operand& p, std::size_t q, bool two_sided) {
    std::size_t axes = 0;
    for (int i = 0; i < 3; ++i) axes |= node.period[i] > 0 ? std::size_t{1} << i : 0;
    const Operand result = samples() ? code_.declare("v", FIELD_NO_SAMPLE, {})
                                     : code_.declare("v", FIELD_COPY, {Operand::literal(1e20f)});
    code_.begin_cells(axes);
    const Operand at = define(FIELD_REPEAT_CELL, {p}, q);
    const Operand child = visit(node.children[0], at, two_sided);
    code_.assign(result, samples() ? FIELD_UNITE_CELLS_SAMPLES : FIELD_UNITE_CELLS, {result, child});
    code_.end();
    return result;
  }

  /// `prefix` names the functions; `q` is their table's type.
  std::string dispatch(const char* prefix, const char* q) const {
    std::string out;
    const bool near = std::find(uneven_.begin(), uneven_.end(), true) != uneven_.end();
    if (near) out += uneven_fields();
    for (int kind = 0; kind < (near ? 4 : 3); ++kind) {
      out += fmt::format("static inline {} {}{}(u32 field, REAL3 p, {}{} q) {{\n  switch (field) {{\n",
                         type_name(kinds[kind].type), prefix, kinds[kind].suffix,
                         kind == 2 ? "" : "MASK active, ", q);
      for (std::size_t i = 0; i + 1 < out_.fields.size(); ++i)
        out += fmt::format("    case {}u: return field{}_{}(p, {}, q);\n", i, i, suffix_of(i, kind),
                           kind == 2 ? "ALL_LANES" : "active");
      out += fmt::format("    default: return field{}_{}(p, {}, q);\n  }}\n}}\n\n", out_.fields.size() - 1,
                         suffix_of(out_.fields.size() - 1, kind), kind == 2 ? "ALL_LANES" : "active");
    }
    return out;
  }

  /// Functions for marching fields in doubles.
  std::string shallow_functions() const {
    std::string out =
        "static inline REAL3 sdf_place(u32 field, REAL3 p, __global const float* restrict q) {\n  const u32 "
        "o = SDF_ORIGINS + 3u * field;\n  return real3(p.x + q[o], p.y + q[o + 1u], p.z + q[o + 2u]);\n}\n\n";
    for (int kind = 0; kind < 4; ++kind) {
      if (kind == 3 && std::find(uneven_.begin(), uneven_.end(), true) == uneven_.end()) break;
      out += fmt::format(
          "static inline {0} sdf_{1}(u32 field, REAL3 p, {2}__global const float* restrict q) {{\n  return "
          "{3}(deep_{1}(field, deep_place(p, q, SDF_ORIGINS + 3u * field), {4}DEEP_TABLE(q)));\n}}\n\n",
          type_name(kinds[kind].type), kinds[kind].suffix, kind == 2 ? "" : "MASK active, ",
          kind == 2 ? "shallow_sample" : "DEEP_TO", kind == 2 ? "" : "DEEP_FROM_MASK(active), ");
    }
    return out;
  }

  /// Emits sdf_uneven(), and SDF_HAS_NEAR, without which marching does not call it.
  std::string uneven_fields() const {
    std::string out =
        "#define SDF_HAS_NEAR 1\nstatic inline bool sdf_uneven(u32 field, __global const float* restrict q) "
        "{\n  return false";
    for (std::size_t i = 0; i < uneven_.size(); ++i)
      if (uneven_[i]) out += fmt::format(" || field == {}u", i);
    return out + ";\n}\n\n";
  }

  /// The suffix of a field's function; even fields have no separate near function.
  const char* suffix_of(std::size_t field, int kind) const {
    return kinds[kind == 3 && !uneven_[field] ? 1 : kind].suffix;
  }

  static int iterations_of(const SdfNode& node) {
    int sum = node.kind == SdfNode::Kind::formula  ? node.formula.iterations
              : node.kind == SdfNode::Kind::native ? 100  // unknown cost
                                                   : 0;
    for (const SdfNode& child : node.children) sum += iterations_of(child);
    return node.kind == SdfNode::Kind::repeat ? 8 * sum : sum;  // it evaluates up to eight cells
  }

  static bool is_smooth(const SdfNode& node) {
    if (node.kind == SdfNode::Kind::native) return false;
    if (node.kind == SdfNode::Kind::formula)
      return std::all_of(node.formula.steps.begin(), node.formula.steps.end(),
                         [](const FormulaStep& step) { return step.definition.smooth; });
    return std::all_of(node.children.begin(), node.children.end(), is_smooth);
  }

  SdfField record(const SdfDescription& d) {
    const auto f = [](double value) { return static_cast<float>(value); };
    SdfField r{};
    r.lower = {f(d.lower.x), f(d.lower.y), f(d.lower.z), f(d.least)};
    r.upper = {f(d.upper.x), f(d.upper.y), f(d.upper.z), f(d.greatest)};
    if (d.sphere) r.sphere = {f(d.sphere->x), f(d.sphere->y), f(d.sphere->z), f(d.sphere->w)};
    r.safety = 1;
    const bool smooth = is_smooth(d.root);
    r.detail = f(d.detail.value_or(smooth ? 0.05 : 0.5));
    r.normal_width = 0.5f;
    r.iterations = static_cast<u32>(std::max(1, iterations_of(d.root)));
    r.step_limit = static_cast<u32>(d.step_limit);
    r.flags = (smooth ? SDF_SMOOTH : 0u) | (d.sphere ? SDF_CUT_SPHERE : 0u);
    r.color_by =
        d.coloring.palette.empty() ? SDF_COLOR_NONE : SDF_COLOR_POINT + static_cast<u32>(d.coloring.by);
    std::vector<double> stops;
    for (const glm::dvec3& stop : d.coloring.palette) stops.insert(stops.end(), {stop.x, stop.y, stop.z});
    r.palette_first = static_cast<u32>(table(stops));
    r.palette_count = static_cast<u32>(d.coloring.palette.size());
    r.palette_scale = f(d.coloring.scale);
    r.palette_offset = f(d.coloring.offset);
    r.occlusion_reach = f(d.occlusion);
    r.shadow_hardness = f(d.soft_shadow);
    r.glow = {f(d.glow.x), f(d.glow.y), f(d.glow.z), f(d.glow_width)};
    return r;
  }

  CompiledFields out_;
  std::vector<double> exact_;               // parameters in double precision
  std::map<std::string, Leaf> leaf_names_;  // by code
  std::string leaves_, fields_;
  FieldCode code_;                             // the function being emitted
  std::vector<std::vector<FieldCode>> codes_;  // functions of each field
  std::vector<std::size_t> places_;
  std::vector<Leaf> leaf_of_place_;
  std::vector<bool> uneven_;  // one per field
  std::size_t next_place_ = 0, next_leaf_ = 0, next_native_ = 0, native_count_ = 0;
  int leaf_count_ = 0, kind_ = 0;
};

}  // namespace

bool have_programs(std::span<const float> parameters) {
  return !parameters.empty() && std::bit_cast<u32>(parameters[0]) != 0;
}

CompiledFields compile_fields(std::span<const SdfDescription> fields) { return FieldsEmitter().run(fields); }

CompiledFields compile_deep_fields(std::span<const DeepField> fields) {
  return FieldsEmitter().run_deep(fields);
}

}  // namespace sundog
