// Prints statements as OpenCL C: an operation becomes its expression in FIELD_OPS with operands for letters.
#include "compile/fields/field_code.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <utility>

namespace sundog {
namespace {

struct OpText {
  FieldType type;
  const char* expression;
};

#define SUNDOG_REAL_OP(name, expression) OpText{FieldType::real, #expression},
#define SUNDOG_MASK_OP(name, expression) OpText{FieldType::mask, #expression},
#define SUNDOG_POINT_OP(name, expression) OpText{FieldType::point, #expression},
#define SUNDOG_SAMPLE_OP(name, expression) OpText{FieldType::sample, #expression},
constexpr OpText op_texts[] = {FIELD_OPS(SUNDOG_REAL_OP, SUNDOG_MASK_OP, SUNDOG_POINT_OP, SUNDOG_SAMPLE_OP)};
#undef SUNDOG_REAL_OP
#undef SUNDOG_MASK_OP
#undef SUNDOG_POINT_OP
#undef SUNDOG_SAMPLE_OP

/// Replaces each word of `expression` by value(word).
template <class Value>
std::string replace_words(const std::string& expression, const Value& value) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::string out;
  for (std::size_t at = 0; at < expression.size();) {
    std::size_t end = at;
    while (end < expression.size() && in_word(expression[end])) ++end;
    if (end == at) {
      out += expression[at++];
      continue;
    }
    out += value(expression.substr(at, end - at));
    at = end;
  }
  return out;
}

/// The operand that a word in an expression denotes, or -1.
int operand_of(const std::string& word) {
  const bool prefixed = word.size() == 2 && (word[0] == 'M' || word[0] == 'P' || word[0] == 'S');
  if (word.size() != 1 && !prefixed) return -1;
  const char letter = word.back();
  return letter >= 'A' && letter <= 'D' ? letter - 'A' : -1;
}

}  // namespace

FieldType type_of(FieldOp op) { return op_texts[op].type; }

const char* type_name(FieldType type) {
  static constexpr std::array<const char*, 4> names{"REAL", "MASK", "REAL3", "SdfSample"};
  return names[static_cast<std::size_t>(type)];
}

std::string literal(double value) {
  if (value != static_cast<float>(value)) return fmt::format("(REAL)(LITERAL({:#.17g}))", value);
  std::string text = fmt::format("{:.9g}", static_cast<float>(value));
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return "(REAL)(" + text + "f)";
}

FieldCode::FieldCode() {
  argument("p", FieldType::point);
  argument("active", FieldType::mask);
}

Operand FieldCode::argument(const std::string& name, FieldType type) {
  const int uses = ++names_[name];
  variables_.push_back({uses > 1 ? fmt::format("{}_{}", name, uses) : name, type});
  return {Operand::Kind::variable, variables_.size() - 1, -1, 0};
}

Operand FieldCode::add(const std::string& name, FieldStatement statement, FieldType type, bool constant) {
  const Operand variable = argument(name, type);
  statement.result = variable.index;
  statement.declares = true;
  statement.constant = constant;
  statements_.push_back(std::move(statement));
  return variable;
}

Operand FieldCode::define(const std::string& name, FieldOp op, Operands operands, std::size_t number) {
  FieldStatement s;
  s.op = op;
  s.operands = std::move(operands);
  s.number = number;
  return add(name, std::move(s), type_of(op), true);
}

Operand FieldCode::declare(const std::string& name, FieldOp op, Operands operands) {
  const Operand variable = define(name, op, std::move(operands));
  statements_.back().constant = false;
  return variable;
}

void FieldCode::assign(const Operand& variable, FieldOp op, Operands operands) {
  FieldStatement s;
  s.op = op;
  s.result = variable.index;
  s.operands = std::move(operands);
  statements_.push_back(std::move(s));
}

Operand FieldCode::assemble(const std::string& name, FieldType type, Operands numbers) {
  FieldStatement s;
  s.kind = FieldStatement::Kind::assemble;
  s.operands = std::move(numbers);
  return add(name, std::move(s), type, true);
}

Operand FieldCode::call(const std::string& function, FieldType type, const Operand& point, std::size_t table,
                        std::shared_ptr<const FieldCode> callee) {
  FieldStatement s;
  s.kind = FieldStatement::Kind::call;
  s.function = function;
  s.operands = {point};
  s.number = table;
  s.callee = std::move(callee);
  return add("v", std::move(s), type, true);
}

void FieldCode::add_control(FieldStatement::Kind kind, std::size_t number, std::size_t end,
                            Operands operands) {
  FieldStatement s;
  s.kind = kind;
  s.number = number;
  s.end = end;
  s.operands = std::move(operands);
  statements_.push_back(std::move(s));
}

void FieldCode::begin_iterations(std::size_t table) { add_control(FieldStatement::Kind::iterate, table, 0); }
void FieldCode::leave_if_none(const Operand& mask) { add_control(FieldStatement::Kind::leave, 0, 0, {mask}); }
void FieldCode::begin_turn(std::size_t total, std::size_t end) {
  add_control(FieldStatement::Kind::take_turn, total, end);
}
void FieldCode::next_turn(std::size_t end) { add_control(FieldStatement::Kind::next_turn, 0, end); }
void FieldCode::begin_cells(std::size_t axes) {
  add_control(FieldStatement::Kind::cells, axes, 0);
  statements_.back().function = fmt::format("n{}", ++names_["cell"]);
}
void FieldCode::end() { add_control(FieldStatement::Kind::end, 0, 0); }

std::string FieldCode::text(const Operand& operand) const {
  switch (operand.kind) {
    case Operand::Kind::variable:
      return variables_[operand.index].name +
             (operand.part < 0 ? "" : fmt::format(".{}", "xyz"[operand.part]));
    case Operand::Kind::table:
      return fmt::format("(REAL)(q[{}])", operand.index);
    case Operand::Kind::literal:
      return literal(operand.value);
    case Operand::Kind::none:
      break;
  }
  return "";
}

std::string FieldCode::value_of(const FieldStatement& s, const std::string& cell) const {
  if (s.kind == FieldStatement::Kind::call)
    return s.callee ? fmt::format("{}({}, active, q + {})", s.function, text(s.operands[0]), s.number)
                    : fmt::format("{}({})", s.function, text(s.operands[0]));
  if (s.kind == FieldStatement::Kind::assemble) {
    std::vector<std::string> parts;
    for (const Operand& operand : s.operands) parts.push_back(text(operand));
    if (parts.size() == 3) return fmt::format("real3({})", fmt::join(parts, ", "));
    return fmt::format("{{{}, {{{}}}, {}}}", parts[0], fmt::join(parts.begin() + 1, parts.begin() + 4, ", "),
                       fmt::join(parts.begin() + 4, parts.end(), ", "));
  }
  return replace_words(op_texts[s.op].expression, [&](const std::string& word) {
    if (const int operand = operand_of(word); operand >= 0)
      return text(s.operands[static_cast<std::size_t>(operand)]);
    if (word == "T") return fmt::format("q[{}]", s.number);
    if (word == "Q") return fmt::format("q + {}", s.number);
    if (word == "N") return std::to_string(s.number);
    if (word == "I") return std::string("i");
    return word == "K" ? cell : word;
  });
}

std::string FieldCode::statements_text() const {
  using Kind = FieldStatement::Kind;
  std::string out, cell;
  for (const FieldStatement& s : statements_) {
    out += "    ";
    switch (s.kind) {
      case Kind::compute:
      case Kind::assemble:
      case Kind::call: {
        const Variable& variable = variables_[s.result];
        if (s.declares) out += fmt::format("{}{} ", s.constant ? "const " : "", type_name(variable.type));
        out += fmt::format("{} = {};\n", variable.name, value_of(s, cell));
        break;
      }
      case Kind::iterate:
        out += fmt::format(
            "const u32 iterations = (u32)q[{}];\n    u32 i = 0;\n    for (; i < iterations; ++i) {{\n",
            s.number);
        break;
      case Kind::leave:
        out += fmt::format("if (!any_lane({})) break;\n", text(s.operands[0]));
        break;
      case Kind::take_turn:
        out += fmt::format("const u32 turn = i % {}u;\n    if (turn < {}u) {{\n", s.number, s.end);
        break;
      case Kind::next_turn:
        out += s.end ? fmt::format("}} else if (turn < {}u) {{\n", s.end) : "} else {\n";
        break;
      case Kind::cells:
        cell = s.function;
        out += fmt::format("for (u32 {0} = 0; {0} < 8u; ++{0}) {{\n    if ({0} & {1}u) continue;\n", cell,
                           ~s.number & 7u);
        break;
      case Kind::end:
        out += "}\n";
        break;
    }
  }
  return out;
}

std::string FieldCode::text() const {
  return statements_text() + fmt::format("    return {};\n", text(result_));
}

}  // namespace sundog
