// Parses the formula language to a tree. Statements "name = expression" end with ';' or a newline; comments
// start with //, not #.
//
//     t = abs(z)                       z, c, p: points (vec3, or quat); r = |z|; i: the iteration's number
//     z = t ^ power + c                ^ binds closest and to the right, then unary -, * /, + -, comparisons,
//     &&, ||, ?: z.x = z.x > 0 ? z.x : -z.x       components x y z w, or several: v.zxy
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "formula/error.h"

namespace sundog {

struct SourcePlace {
  int line = 1, column = 1;
};

/// number: value. name: text. negate, opposite: one operand. binary: text is the operator. choose: three
/// operands. call: text is the function. member: text is the components.
struct Expression {
  enum class Kind { number, name, negate, opposite, binary, choose, call, member } kind = Kind::number;
  SourcePlace place;
  std::string text;
  double value = 0;
  std::vector<Expression> operands;
  int depth = 1;  // depth of this tree, at most FormulaLimits::tree_depth
};

struct Statement {
  SourcePlace place;
  std::string target;
  std::string members;  // "x" in "z.x = ...", else empty
  Expression value;
};

struct FormulaLimits {
  static constexpr std::size_t characters = 8192, statements = 200, name_length = 32;
  static constexpr int nesting = 64, tree_depth = 400;
};

/// Throws FormulaError with line and column.
std::vector<Statement> parse_statements(std::string_view text);

/// Statements and a final expression.
struct FormulaBody {
  std::vector<Statement> statements;
  Expression result;
};
FormulaBody parse_body(std::string_view text);

/// Whether a word is reserved by C, OpenCL C or the formula language.
bool is_reserved_word(std::string_view word);

}  // namespace sundog
