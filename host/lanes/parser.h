// Parses plain kernels (OpenCL C 1.2 for one path, with the words that kernels/README.md lists) to a typed
// tree; rejects unknown constructs. Interfaces may also have:
//   UNIFORM T f(...)                      a hand-written function that gives one value for all lanes
//   LANE_VECTOR(Type, Type, prefix, 4)    a vector of x to w: prefix_add, prefix_scale, ...
#pragma once
#include "lanes/tree.h"

namespace sundog::spmd {

using IsPlain = std::function<bool(const std::string& path)>;

/// A recursive-descent parser. Throws BuildError with the place. Skips the bodies of functions in files for
/// which `is_plain` is false; these may be called with uniform arguments.
class Parser {
 public:
  explicit Parser(IsPlain is_plain);
  /// Adds the tokens' declarations to the program.
  void read(Tokens tokens);
  const Program& program() const { return out_; }

 private:
  // Tokens.
  const Token& word(std::size_t ahead = 0) const;
  const Place& place() const { return word().place; }
  bool at(std::string_view text) const { return word().is(text); }
  bool at_name() const { return word().kind == Token::Kind::name; }
  bool take(std::string_view text);
  void want(std::string_view text);
  std::string name(std::string_view what);
  std::vector<std::string> words_in_brackets(std::size_t least);
  void skip_brackets();
  /// Calls `read` for each element up to `end`; commas separate elements.
  template <class Read>
  void list_until(std::string_view end, const Read& read) {
    while (!take(end)) {
      read();
      if (!at(end)) want(",");
    }
  }

  // Declarations (parse_declarations.cpp).
  void declaration();
  void type_definition();
  void add_vector(const VectorForm& form);
  void structure();
  void members(Structure& s);
  void function();
  void parameter(Function& f);
  bool begins_type() const { return at("const") || at("__global") || types_.contains(word().text); }
  Type base_type();
  /// Parses `type *const restrict`, then `name[3]` in declarators.
  Type pointed(Type type);
  Type lengthened(Type type);

  // Statements (parse_statements.cpp).
  StatementPtr statement();
  StatementPtr block();
  StatementPtr declared();
  StatementPtr branch();
  StatementPtr loop();
  StatementPtr do_loop();
  StatementPtr each_alike();
  StatementPtr given();
  StatementPtr unscoped_statement();
  bool begins_declaration() const;
  StatementPtr made(Statement::Kind kind) const;
  const Variable* declare(const std::string& named, const Type& type, const Place& where);

  // Expressions (parse_expressions.cpp).
  ExpressionPtr expression();
  ExpressionPtr condition();
  ExpressionPtr in_brackets();
  ExpressionPtr conditional();
  void refuse_steps(const Expression& e) const;
  ExpressionPtr binary(int least);
  ExpressionPtr combined(const Token& sign, ExpressionPtr a, ExpressionPtr b) const;
  ExpressionPtr unary();
  ExpressionPtr cast_or_brackets();
  ExpressionPtr vector_of(const Type& type, const Place& where);
  template <class... Parts>
  ExpressionPtr made(Expression::Kind kind, const Type& type, const Place& where,
                     const std::string& text = "", Parts... parts) const {
    auto e = std::make_shared<Expression>(Expression{kind, type, where, text, {std::move(parts)...}});
    e->type.constant = false;
    return e;
  }
  ExpressionPtr converted(ExpressionPtr e, const Type& type) const;
  ExpressionPtr truth(ExpressionPtr e) const;
  ExpressionPtr postfix(ExpressionPtr of);
  ExpressionPtr stepped(const Token& sign, ExpressionPtr of, bool postfix) const;
  ExpressionPtr part_of(ExpressionPtr of, bool arrow);
  ExpressionPtr number();
  ExpressionPtr named();
  ExpressionPtr call(const Token& called);
  ExpressionPtr built_in(const Token& called, std::vector<ExpressionPtr> given) const;
  ExpressionPtr list(const Type& type);
  ExpressionPtr initial(const Type& type);
  std::vector<ExpressionPtr> arguments();

  const Type& type(const std::string& named) const { return types_.at(named); }
  const Type& scalar(Type::Kind kind) const;

  IsPlain is_plain_;
  Tokens tokens_;
  std::size_t at_ = 0;
  Program out_;
  std::map<std::string, Type> types_, constants_;
  std::vector<const Variable*> known_;                  // visible names; none hides another
  std::map<const std::string*, std::string> features_;  // of files: HAVING(HAS_X);
  const Function* function_ = nullptr;                  // the function being parsed
};

}  // namespace sundog::spmd
