// The recursive-descent parser, in three files: declarations, statements and expressions.
#pragma once
#include <set>

#include "lanes/parse.h"

namespace sundog::spmd {

class Parser {
 public:
  Parser(const Source& source, const std::function<bool(const std::string&)>& is_plain);
  Program program();

 private:
  // Tokens.
  const Token& word(std::size_t ahead = 0) const;
  const Place& place() const { return word().place; }
  bool at(std::string_view text) const { return word().is(text); }
  bool take(std::string_view text);
  void want(std::string_view text);
  std::string name(std::string_view what);
  void skip_brackets();

  // Declarations (parse_declarations.cpp).
  void declaration();
  void plain_declaration();
  void skip_declaration();
  void type_definition();
  void vector_definition();
  void enumeration();
  void structure(Structure& s);
  void members(Structure& s);
  void function();
  void parameters(Function& f);
  bool begins_type(std::size_t ahead = 0) const;
  Type base_type();
  /// Parses `type *const restrict`, then `name[3]` in declarators.
  Type pointed(Type type);
  Type lengthened(Type type);
  const Structure* made_structure(std::string named, Structure&& s);

  // Statements (parse_statements.cpp).
  StatementPtr statement();
  StatementPtr block();
  StatementPtr declared();
  StatementPtr branch();
  StatementPtr loop();
  StatementPtr do_loop();
  StatementPtr each_alike();
  StatementPtr given();
  StatementPtr made(Statement::Kind kind) const;
  const Variable* declare(std::string named, Type type, const Place& where);

  // Expressions (parse_expressions.cpp).
  ExpressionPtr expression();
  ExpressionPtr condition();
  ExpressionPtr conditional();
  void refuse_steps(const Expression& e) const;
  ExpressionPtr binary(int least);
  ExpressionPtr combined(const Token& sign, ExpressionPtr a, ExpressionPtr b);
  ExpressionPtr unary();
  ExpressionPtr cast_or_brackets();
  ExpressionPtr vector_of(Type type, const Place& where);
  ExpressionPtr postfix(ExpressionPtr of);
  ExpressionPtr part_of(ExpressionPtr of, bool arrow);
  ExpressionPtr primary();
  ExpressionPtr number();
  ExpressionPtr named();
  ExpressionPtr call(const Token& called);
  ExpressionPtr built_in(const Token& called, std::vector<ExpressionPtr> given);
  ExpressionPtr list(const Type& type);
  ExpressionPtr initial(const Type& type);
  ExpressionPtr made(Expression::Kind kind, Type type, const Place& where) const;
  ExpressionPtr converted(ExpressionPtr e, const Type& type) const;
  ExpressionPtr truth(ExpressionPtr e) const;
  std::vector<ExpressionPtr> arguments();

  const Type& part_type(const Type& vector) const;

  const Tokens& tokens_;
  const std::function<bool(const std::string&)>& is_plain_;
  std::size_t at_ = 0;
  Program out_;
  std::map<std::string, Type> types_;
  std::map<std::string, Type> constants_;
  std::vector<std::map<std::string, const Variable*>> scopes_;
  std::map<const std::string*, std::string> features_;  // of files: HAVING(HAS_X);
  const Function* function_ = nullptr;                  // the function being parsed
};

/// The precedence of a binary operator, 0 for other tokens.
int strength_of(const std::string& sign);

}  // namespace sundog::spmd
