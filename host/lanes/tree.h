// The typed syntax tree of a plain kernel.
#pragma once
#include <algorithm>
#include <map>
#include <memory>

#include "lanes/preprocess.h"

namespace sundog::spmd {

struct Structure;

/// A vector type whose lane form has functions in place of operators: float3 becomes REAL3, with add3,
/// scale3, ...; interfaces declare others, which always vary: SampledSpectrum has spectrum_add, ...
struct VectorForm {
  std::string name, lanes, prefix;  // an empty prefix: the functions end in the number of parts
  int parts = 0;
  std::string function(const std::string& operation) const;
};

struct Type {
  enum class Kind { nothing, boolean, integer, natural, real, vector, structure, pointer, array };
  Kind kind = Kind::nothing;
  std::string name = {};             // for one path, in the device's compiler
  const VectorForm* form = nullptr;  // of a vector
  const Structure* structure = nullptr;
  std::shared_ptr<const Type> of = {};    // of a pointer or array
  int length = 0;                         // of an array
  bool constant = false, global = false;  // global: of the device's memory, or a pointer to it

  bool is(Kind k) const { return kind == k; }
  bool is_nothing() const { return is(Kind::nothing); }
  bool is_truth() const { return is(Kind::boolean); }
  bool is_whole() const { return is(Kind::integer) || is(Kind::natural); }
  bool is_natural() const { return is(Kind::natural); }
  bool is_real() const { return is(Kind::real); }
  bool is_number() const { return is_truth() || is_whole() || is_real(); }
  bool is_vector() const { return is(Kind::vector); }
  bool is_structure() const { return is(Kind::structure); }
  bool is_array() const { return is(Kind::array); }
  bool is_pointer() const { return is(Kind::pointer); }
  bool is_table() const { return is_pointer() && global; }
  bool is_own_pointer() const { return is_pointer() && !global; }
  /// Whether a value of this type can be used unchanged where `wanted` is expected.
  bool fits(const Type& wanted) const;
  /// Whether its lane form is hand-written; for structures, `joins`: whether lanes of two can be joined.
  bool is_by_hand() const;
  bool joins() const;
};

Type pointer_to(const Type& type);
/// "a float3", "a pointer"; for messages.
std::string name_of(const Type& type);

struct Member {
  std::string name;
  Type type;
  std::string feature;  // the feature that it needs; empty: none
};

struct Structure {
  std::string name, lanes;  // for one path; the lane form, generated unless hand-written
  std::string join;         // hand-written: join(&mine, &other, lanes) takes lanes of another; empty: none
  bool by_hand = false;
  bool shared = false;  // of a header shared with the host: only in tables, or uniform
  std::vector<Member> members;
  Place place;
  const Member* member(const std::string& wanted) const;
};

struct Variable {
  std::string name;
  Type type;
  bool uniform = false, here = false;  // here: the place of the mask in a hand-written function's parameters
  bool out = false;                    // its target becomes undefined in inactive lanes
  Place place;
};

struct Function;
struct Expression;
using ExpressionPtr = std::shared_ptr<Expression>;

struct Expression {
  enum class Kind {
    number,     // text
    constant,   // text: a name known to the device's compiler
    variable,   // variable
    member,     // of[0].text; arrow: of[0] is a pointer
    component,  // of[0].text, one letter or more
    index,      // of[0][of[1]]
    unary,      // text of[0]; postfix: reversed
    binary,     // of[0] text of[1]
    assign,     // of[0] = of[1]; += and others are expanded
    choose,     // of[0] ? of[1] : of[2]
    cast,       // (type)of[0]; implicit: omitted
    vector,     // (type)(of...)
    list,       // {of...}
    call,       // function or text
    any         // any(of[0])
  };
  Kind kind = Kind::number;
  Type type;
  Place place;
  std::string text;
  std::vector<ExpressionPtr> of;
  std::string digits = {};  // of a number whose text is a constant's name
  bool arrow = false, postfix = false, implicit = false;
  const Variable* variable = nullptr;
  const Function* function = nullptr;

  bool is_binary(std::string_view sign) const { return kind == Kind::binary && text == sign; }
  bool is_unary(std::string_view sign) const { return kind == Kind::unary && text == sign; }
  bool steps() const { return is_unary("++") || is_unary("--"); }
  /// Whether it divides whole numbers, which traps if the divisor is zero.
  bool divides_whole() const { return (is_binary("/") || is_binary("%")) && type.is_whole(); }
  /// The structure or vector that a member or component belongs to.
  const Type& whole() const { return of[0]->type.is_pointer() ? *of[0]->type.of : of[0]->type; }
};

/// Whether `test` holds for e or something within.
template <class Test>
bool any_within(const Expression& e, const Test& test) {
  return test(e) || std::ranges::any_of(e.of, [&](const auto& part) { return any_within(*part, test); });
}

/// Kinds of binary operators.
bool compares(std::string_view sign);
bool joins(std::string_view sign);  // && and ||

/// OpenCL's functions of single numbers.
struct BuiltIn {
  std::size_t arguments = 1;
  Type::Kind takes{}, gives{};  // `nothing`: takes any number
  std::string lanes = {};       // its name for lanes, if different
  double cost = 1;
};
const BuiltIn* built_in_of(const std::string& name);

struct Statement;
using StatementPtr = std::unique_ptr<Statement>;

struct Statement {
  enum class Kind {
    block,       // body...
    declare,     // variables with initialisers, which may be null
    branch,      // if (expressions[0]) body[0] else body[1]; feature: by the preprocessor
    loop,        // for (body[0]; expressions[0]; expressions[1]) body[1]; expressions[1] may be missing
    each_alike,  // variables[0] takes each distinct value of expressions[0]: body[0]
    leave_loop,  // break
    next_round,  // continue
    give,        // return expressions[0], which may be missing
    compute,     // expressions[0]
  };
  Kind kind = Kind::block;
  Place place;
  std::vector<const Variable*> variables;
  std::vector<ExpressionPtr> expressions;
  std::vector<StatementPtr> body;
  std::string feature;

  bool is(Kind k) const { return kind == k; }
};

/// Calls `visit` for s and all within.
template <class Visit>
void each_within(const Statement& s, const Visit& visit) {
  visit(s);
  for (const StatementPtr& inner : s.body) each_within(*inner, visit);
}

struct Function {
  std::string name, lanes;  // `lanes`: name of the hand-written function
  Type result;
  std::vector<const Variable*> parameters, taken;  // taken: parameters that a call passes
  std::string feature;                             // the feature that it needs; empty: none
  StatementPtr body;                               // none: hand-written
  bool is_inline = false, is_entry = false, takes_mask = false, uniform = false;  // uniform: its result
  Place place;
};

struct Program {
  std::deque<VectorForm> forms;
  std::deque<Structure> structures;
  std::deque<Variable> variables;
  std::deque<Function> functions;
  std::map<std::string, const Function*> function_of;
};

/// A parameter used as a pointer to a lane's own value.
bool is_own_pointer(const Variable* v);

/// Size and alignment of a value in a table, in bytes, by OpenCL's rules.
int size_of(const Type& type);
int alignment_of(const Type& type);
int offset_of(const Structure& structure, const std::string& name);

}  // namespace sundog::spmd
