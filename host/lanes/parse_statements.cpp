// Statements.
#include <fmt/format.h>

#include "lanes/parser.h"

namespace sundog::spmd {
namespace {

/// The preprocessor's text of a condition of features alone, else empty.
std::string feature_text(const Expression& e) {
  using Kind = Expression::Kind;
  if (e.kind == Kind::constant && e.text.starts_with("HAS_")) return e.text;
  if (e.kind == Kind::cast && e.implicit) return feature_text(*e.of[0]);
  if (e.kind == Kind::unary && e.text == "!") {
    const std::string of = feature_text(*e.of[0]);
    return of.empty() ? of : "!" + of;
  }
  if (e.kind != Kind::binary || (e.text != "&&" && e.text != "||")) return "";
  const std::string a = feature_text(*e.of[0]), b = feature_text(*e.of[1]);
  return a.empty() || b.empty() ? "" : fmt::format("({} {} {})", a, e.text, b);
}

/// Takes the features out that a chain of && begins with.
std::string take_features(ExpressionPtr& e) {
  if (std::string all = feature_text(*e); !all.empty()) {
    e = nullptr;
    return all;
  }
  if (e->kind != Expression::Kind::binary || e->text != "&&") return "";
  std::string first = take_features(e->of[0]);
  if (!e->of[0]) {
    ExpressionPtr rest = std::move(e->of[1]);
    e = std::move(rest);
  }
  return first;
}

}  // namespace

StatementPtr Parser::made(Statement::Kind kind) const {
  auto s = std::make_unique<Statement>();
  s->kind = kind;
  s->place = place();
  return s;
}

const Variable* Parser::declare(std::string named, Type type, const Place& where) {
  Variable v;
  v.name = std::move(named);
  v.type = std::move(type);
  v.place = where;
  const std::size_t stem = v.name.find_last_not_of("0123456789");
  if (stem + 1 < v.name.size() && v.name[stem] == '_')
    fail(where, fmt::format("'{}': names that end in _ and a number are the translator's", v.name));
  for (const auto& scope : scopes_)
    if (scope.contains(v.name)) fail(where, fmt::format("'{}' hides another one", v.name));
  const Variable& kept = out_.variables.emplace_back(std::move(v));
  scopes_.back()[kept.name] = &kept;
  return &kept;
}

StatementPtr Parser::statement() {
  if (at("{")) return block();
  if (at("if")) return branch();
  if (at("for") || at("while")) return loop();
  if (at("do")) return do_loop();
  if (at("EACH_ALIKE")) return each_alike();
  if (at("return")) return given();
  for (const char* word : {"goto", "switch"})
    if (at(word)) fail(place(), fmt::format("'{}' has no lanes: use if", word));
  if (begins_type() && !word(1).is("(")) return declared();
  StatementPtr s = made(at("break")      ? Statement::Kind::leave_loop
                        : at("continue") ? Statement::Kind::next_round
                        : at(";")        ? Statement::Kind::block
                                         : Statement::Kind::compute);
  if (s->kind == Statement::Kind::compute)
    s->expressions.push_back(expression());
  else if (!at(";"))
    ++at_;
  want(";");
  return s;
}

StatementPtr Parser::block() {
  StatementPtr s = made(Statement::Kind::block);
  want("{");
  scopes_.emplace_back();
  while (!take("}")) {
    if (word().kind == Token::Kind::end) fail(s->place, "a block has no end");
    s->body.push_back(statement());
  }
  scopes_.pop_back();
  return s;
}

StatementPtr Parser::declared() {
  StatementPtr s = made(Statement::Kind::declare);
  const Type base = base_type();
  do {
    const Place where = place();
    Type type = pointed(base);
    std::string named = name("a variable");
    type = lengthened(std::move(type));
    if (type.is_own_pointer() && !type.constant)
      fail(where, "a pointer to what may be set is a parameter alone");
    ExpressionPtr value;
    if (take("=")) value = initial(type);
    s->variables.push_back(declare(std::move(named), std::move(type), where));
    s->expressions.push_back(std::move(value));
  } while (take(","));
  want(";");
  return s;
}

StatementPtr Parser::branch() {
  StatementPtr s = made(Statement::Kind::branch);
  want("if");
  want("(");
  ExpressionPtr asked = truth(condition());
  want(")");
  scopes_.emplace_back();
  StatementPtr then = statement(), otherwise;
  scopes_.pop_back();
  if (take("else")) {
    scopes_.emplace_back();
    otherwise = statement();
    scopes_.pop_back();
  }
  // Features are the preprocessor's: `if (HAS_X && c) s` is `#if HAS_X`, `if (c) s`.
  if (!otherwise || !feature_text(*asked).empty()) s->feature = take_features(asked);
  if (!s->feature.empty() && asked) {
    StatementPtr inner = made(Statement::Kind::branch);
    inner->place = s->place;
    inner->expressions.push_back(std::move(asked));
    inner->body.push_back(std::move(then));
    then = std::move(inner);
  }
  if (s->feature.empty()) s->expressions.push_back(std::move(asked));
  s->body.push_back(std::move(then));
  if (otherwise) s->body.push_back(std::move(otherwise));
  return s;
}

StatementPtr Parser::loop() {
  StatementPtr s = made(Statement::Kind::loop);
  const bool counts = at("for");
  ++at_;
  want("(");
  scopes_.emplace_back();
  StatementPtr first;
  ExpressionPtr asked, step;
  if (counts && !take(";")) first = statement();
  if (!at(counts ? ";" : ")")) asked = truth(condition());
  if (counts) {
    want(";");
    if (!at(")")) step = expression();
  }
  want(")");
  s->expressions.push_back(std::move(asked));
  s->expressions.push_back(std::move(step));
  s->body.push_back(std::move(first));
  s->body.push_back(statement());
  scopes_.pop_back();
  return s;
}

StatementPtr Parser::do_loop() {
  StatementPtr s = made(Statement::Kind::do_loop);
  want("do");
  StatementPtr body = statement();
  want("while");
  want("(");
  s->expressions.push_back(truth(condition()));
  s->expressions.push_back(nullptr);
  want(")");
  want(";");
  s->body.push_back(nullptr);
  s->body.push_back(std::move(body));
  return s;
}

StatementPtr Parser::each_alike() {
  StatementPtr s = made(Statement::Kind::each_alike);
  want("EACH_ALIKE");
  want("(");
  const Type type = base_type();
  if (!type.is_whole()) fail(place(), "EACH_ALIKE takes whole numbers");
  want(",");
  const Place where = place();
  std::string named = name("a variable");
  want(",");
  s->expressions.push_back(converted(condition(), type));
  want(")");
  scopes_.emplace_back();
  s->variables.push_back(declare(std::move(named), type, where));
  s->body.push_back(statement());
  scopes_.pop_back();
  return s;
}

StatementPtr Parser::given() {
  StatementPtr s = made(Statement::Kind::give);
  want("return");
  const Type& wanted = function_->result;
  if (wanted.is(Type::Kind::nothing) != at(";"))
    fail(place(), fmt::format("'{}' gives {}", function_->name, name_of(wanted)));
  if (!at(";")) s->expressions.push_back(converted(condition(), wanted));
  want(";");
  return s;
}

}  // namespace sundog::spmd
