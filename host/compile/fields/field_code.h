// A distance field's code as statements over named values, printed as OpenCL C or packed into a program for
// the kernels' interpreter (field_program.h).
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "shared/field_ops.h"

namespace sundog {

enum class FieldType { real, mask, point, sample };

/// The type of an operation's result.
FieldType type_of(FieldOp op);
/// The kernels' name: REAL, MASK, REAL3 or SdfSample.
const char* type_name(FieldType type);

/// A variable or a component of one, an entry of the table, or a literal.
struct Operand {
  enum class Kind { none, variable, table, literal } kind = Kind::none;
  std::size_t index = 0;  // index of the variable, or into the table
  int part = -1;          // a point's coordinate, 0 to 2; -1: the whole value
  double value = 0;

  static Operand literal(double value) { return {Kind::literal, 0, -1, value}; }
  static Operand table(std::size_t index) { return {Kind::table, index, -1, 0}; }
  Operand coordinate(int axis) const { return {Kind::variable, index, axis, 0}; }
};
using Operands = std::vector<Operand>;

class FieldCode;

struct FieldStatement {
  enum class Kind {
    compute,    // result = op(operands)
    assemble,   // result = a point or sample from numbers
    call,       // result = callee(point, active, table from `number`)
    iterate,    // until end: repeats as often as the table entry says
    leave,      // breaks if no lane of the mask is set
    take_turn,  // until next_turn or end: runs if the iteration modulo `number` is below `end`
    next_turn,  // the next alternative; `end` 0: all other iterations
    cells,      // until end: for each neighbouring cell along the axes whose bits are in `number`
    end
  } kind = Kind::compute;
  FieldOp op = FIELD_COPY;
  std::size_t result = 0;
  bool declares = false, constant = false;
  Operands operands;
  std::size_t number = 0, end = 0;          // number: T, Q or N in the operation's text
  std::string function;                     // a call's function in kernels; the counter of cells
  std::shared_ptr<const FieldCode> callee;  // none: programs cannot call it
};

/// A function of (p, active, q). Its first two variables are the point and the mask of active lanes.
class FieldCode {
 public:
  FieldCode();
  static Operand point() { return {Operand::Kind::variable, 0, -1, 0}; }
  static Operand active() { return {Operand::Kind::variable, 1, -1, 0}; }

  /// Adds a parameter.
  Operand argument(const std::string& name, FieldType type);
  /// Defines a constant value; `name` is a suggestion.
  Operand define(const std::string& name, FieldOp op, Operands operands, std::size_t number = 0);
  /// Declares a variable with its initial value.
  Operand declare(const std::string& name, FieldOp op, Operands operands);
  void assign(const Operand& variable, FieldOp op, Operands operands);
  /// A point from three numbers, or a sample from eight.
  Operand assemble(const std::string& name, FieldType type, Operands numbers);
  Operand call(const std::string& function, FieldType type, const Operand& point, std::size_t table,
               std::shared_ptr<const FieldCode> callee);

  void begin_iterations(std::size_t table);
  void leave_if_none(const Operand& mask);
  void begin_turn(std::size_t total, std::size_t end);
  void next_turn(std::size_t end);
  void begin_cells(std::size_t axes);
  void end();
  void set_result(const Operand& result) { result_ = result; }

  /// The statements and `return`, as the body of an OpenCL C function.
  std::string text() const;
  std::string statements_text() const;
  std::string text(const Operand& operand) const;

  struct Variable {
    std::string name;
    FieldType type;
  };
  const std::vector<Variable>& variables() const { return variables_; }
  const std::vector<FieldStatement>& statements() const { return statements_; }
  const Operand& result() const { return result_; }

 private:
  Operand add(const std::string& name, FieldStatement statement, FieldType type, bool constant);
  void add_control(FieldStatement::Kind kind, std::size_t number, std::size_t end, Operands operands = {});
  std::string value_of(const FieldStatement& statement, const std::string& cell) const;

  std::vector<Variable> variables_;
  std::vector<FieldStatement> statements_;
  std::map<std::string, int> names_;
  Operand result_;
};

/// An OpenCL C literal, using LITERAL() if a float cannot hold the number.
std::string literal(double value);

}  // namespace sundog
