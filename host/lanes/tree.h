// The typed syntax tree of a plain kernel.
#pragma once
#include <deque>
#include <map>
#include <memory>
#include <optional>

#include "lanes/token.h"

namespace sundog::spmd {

struct Structure;

/// A vector of the language, whose lane form has functions for what operators do: float3 is a REAL3, with
/// add3, scale3, ...; an interface declares others, which are of lanes always: Spectrum is a SampledSpectrum,
/// with spectrum_add, ...
struct VectorForm {
  std::string name, lanes, prefix;  // an empty prefix: the functions end in the number of parts
  int parts = 0;
  std::string function(const std::string& operation) const;
};

enum class Space { own, global, constant, local };

struct Type {
  enum class Kind { nothing, boolean, integer, natural, real, other, vector, structure, pointer, array };
  Kind kind = Kind::nothing;
  std::string name;                  // in the device's compiler, for one path
  const VectorForm* form = nullptr;  // of a vector
  Kind part = Kind::real;            // of a vector
  const Structure* structure = nullptr;
  std::shared_ptr<const Type> of;  // of a pointer or array
  int length = 0;                  // of an array
  Space space = Space::own;        // address space of a pointer's target
  bool constant = false;

  bool is_number() const { return kind >= Kind::boolean && kind <= Kind::other; }
  bool is_whole() const { return kind == Kind::integer || kind == Kind::natural; }
  bool is(Kind k) const { return kind == k; }
  bool is_table() const { return kind == Kind::pointer && space != Space::own; }
  bool is_own_pointer() const { return kind == Kind::pointer && space == Space::own; }
};

struct Member {
  std::string name;
  Type type;
  bool uniform = false;
  std::string feature;  // the feature that the member needs; empty: none
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
  Place place;
};

struct Function;

struct Node {
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
  std::string text, digits;  // digits: of a number whose text is a constant's name
  bool arrow = false, postfix = false, implicit = false;
  const Variable* variable = nullptr;
  const Function* function = nullptr;
  Place place;
};
struct Expression : Node {
  std::vector<std::unique_ptr<Expression>> of;
};
using ExpressionPtr = std::unique_ptr<Expression>;

ExpressionPtr copy_of(const Expression& e);

/// Kinds of operators.
bool compares(const std::string& sign);
bool joins(const std::string& sign);  // && and ||

struct Statement;
using StatementPtr = std::unique_ptr<Statement>;

struct Statement {
  enum class Kind {
    block,       // body...
    declare,     // variables with initialisers, which may be null
    branch,      // if (expressions[0]) body[0] else body[1]; feature: by the preprocessor
    loop,        // for (body[0]; expressions[0]; expressions[1]) body[1]; each may be null
    do_loop,     // do body[1] while (expressions[0])
    each_alike,  // variables[0] takes each distinct value of expressions[0]: body[0]
    leave_loop,  // break
    next_round,  // continue
    give,        // return expressions[0], which may be null
    compute,     // expressions[0]
  };
  Kind kind = Kind::block;
  std::vector<const Variable*> variables;
  std::vector<ExpressionPtr> expressions;
  std::vector<StatementPtr> body;
  std::string feature;
  Place place;
};

struct Function {
  std::string name, lanes;  // `lanes`: name of the hand-written one
  Type result;
  std::vector<const Variable*> parameters;
  std::string feature;  // the feature that it needs; empty: none
  StatementPtr body;    // none: hand-written
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
/// Whether its lane form is hand-written.
bool is_by_hand(const Type& type);
/// The parameters that a call passes.
std::vector<const Variable*> taken(const Function& f);

/// Size and alignment of a value in a table, in bytes, by OpenCL's rules.
int size_of(const Type& type);
int alignment_of(const Type& type);
int offset_of(const Structure& structure, const std::string& name);

/// "a float3", "a pointer"; for messages.
std::string name_of(const Type& type);

}  // namespace sundog::spmd
