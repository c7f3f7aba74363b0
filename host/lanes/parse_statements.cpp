// Parses statements; leaves conditions on features to the preprocessor, and rewrites do loops as while loops.
#include <set>

#include "lanes/parser.h"

namespace sundog::spmd {
namespace {

/// The preprocessor's text of a condition on features only; otherwise empty.
std::string feature_text(const Expression& e) {
  using Kind = Expression::Kind;
  if (e.kind == Kind::constant && e.text.starts_with("HAS_")) return e.text;
  if (e.kind == Kind::cast && e.implicit) return feature_text(*e.of[0]);
  if (e.is_unary("!")) {
    const std::string of = feature_text(*e.of[0]);
    return of.empty() ? of : "!" + of;
  }
  if (e.kind != Kind::binary || !joins(e.text)) return "";
  const std::string a = feature_text(*e.of[0]), b = feature_text(*e.of[1]);
  return a.empty() || b.empty() ? "" : fmt::format("({} {} {})", a, e.text, b);
}

/// Removes the features at the start of a chain of && and returns them; `e` becomes null if nothing else is
/// left.
std::string take_features(ExpressionPtr& e) {
  std::string all = feature_text(*e);
  if (!all.empty()) {
    e = nullptr;
  } else if (e->is_binary("&&")) {
    all = take_features(e->of[0]);
    if (!e->of[0]) e = e->of[1];
  }
  return all;
}

}  // namespace

StatementPtr Parser::made(Statement::Kind kind) const {
  auto s = std::make_unique<Statement>();
  s->kind = kind;
  s->place = place();
  return s;
}

const Variable* Parser::declare(const std::string& named, const Type& type, const Place& where) {
  const std::size_t stem = named.find_last_not_of("0123456789");
  if (stem + 1 < named.size() && named[stem] == '_')
    fail(where, "'{}': names that end in _ and a number are the translator's", named);
  if (std::ranges::find(known_, named, &Variable::name) != known_.end())
    fail(where, "'{}' hides another one", named);
  return known_.emplace_back(&out_.variables.emplace_back(Variable{named, type, false, false, false, where}));
}

bool Parser::begins_declaration() const {
  static const auto& others = *new const std::set<std::string_view>{"return", "goto", "do"};
  const bool has_two_names = at_name() && word(1).kind == Token::Kind::name;
  return (has_two_names && !others.contains(word().text)) || (begins_type() && !word(1).is("("));
}

StatementPtr Parser::statement() {
  const std::size_t outside = known_.size();
  StatementPtr s = unscoped_statement();
  known_.resize(outside);
  return s;
}

StatementPtr Parser::unscoped_statement() {
  if (at("{")) return block();
  if (at("if")) return branch();
  if (at("for") || at("while")) return loop();
  if (at("do")) return do_loop();
  if (at("EACH_ALIKE")) return each_alike();
  if (at("return")) return given();
  if (at("goto") || at("switch")) fail(place(), "'{}' has no lanes: use if", word().text);
  StatementPtr s = made(Statement::Kind::block);
  if (take("break"))
    s->kind = Statement::Kind::leave_loop;
  else if (take("continue"))
    s->kind = Statement::Kind::next_round;
  else if (!at(";")) {
    s->kind = Statement::Kind::compute;
    s->expressions.push_back(expression());
  }
  want(";");
  return s;
}

StatementPtr Parser::block() {
  StatementPtr s = made(Statement::Kind::block);
  want("{");
  while (!take("}")) {
    if (word().kind == Token::Kind::end) fail(s->place, "a block has no end");
    s->body.push_back(begins_declaration() ? declared() : statement());
  }
  return s;
}

StatementPtr Parser::declared() {
  StatementPtr s = made(Statement::Kind::declare);
  const Type base = base_type();
  do {
    const Place where = place();
    Type type = pointed(base);
    const std::string named = name("a variable");
    type = lengthened(std::move(type));
    if (type.is_own_pointer() && !type.constant)
      fail(where, "a pointer to what may be set is a parameter alone");
    s->expressions.push_back(take("=") ? initial(type) : nullptr);
    s->variables.push_back(declare(named, type, where));
  } while (take(","));
  want(";");
  return s;
}

StatementPtr Parser::branch() {
  StatementPtr s = made(Statement::Kind::branch);
  want("if");
  ExpressionPtr asked = truth(in_brackets());
  s->body.push_back(statement());
  if (take("else")) s->body.push_back(statement());
  // The preprocessor tests features: `if (HAS_X && c) s` becomes `#if HAS_X` and `if (c) s`.
  if (s->body.size() == 1 || !feature_text(*asked).empty()) s->feature = take_features(asked);
  if (asked) s->expressions.push_back(std::move(asked));
  if (s->feature.empty() || s->expressions.empty()) return s;
  StatementPtr outer = made(Statement::Kind::branch);
  outer->place = s->place;
  std::swap(outer->feature, s->feature);
  outer->body.push_back(std::move(s));
  return outer;
}

// `do s while (c);` becomes `bool first = true; while (first || c) { first = false; s }`.
StatementPtr Parser::do_loop() {
  const Place where = place();
  const Type& truths = type("bool");
  const Variable* first = declare(fmt::format("first{}_", at_), truths, where);
  const ExpressionPtr is_first = made(Expression::Kind::variable, truths, where, first->name);
  is_first->variable = first;
  const auto set = [&](const char* value) { return made(Expression::Kind::constant, truths, where, value); };
  StatementPtr all = made(Statement::Kind::block), begin = made(Statement::Kind::declare),
               loop = made(Statement::Kind::loop), body = made(Statement::Kind::block),
               mark = made(Statement::Kind::compute);
  begin->variables.push_back(first);
  begin->expressions.push_back(set("true"));
  mark->expressions.push_back(made(Expression::Kind::assign, truths, where, "", is_first, set("false")));
  want("do");
  body->body.push_back(std::move(mark));
  body->body.push_back(statement());
  want("while");
  loop->expressions.push_back(
      made(Expression::Kind::binary, truths, where, "||", is_first, truth(in_brackets())));
  want(";");
  loop->body.push_back(made(Statement::Kind::block));
  loop->body.push_back(std::move(body));
  all->body.push_back(std::move(begin));
  all->body.push_back(std::move(loop));
  return all;
}

StatementPtr Parser::loop() {
  StatementPtr s = made(Statement::Kind::loop);
  StatementPtr first = made(Statement::Kind::block);
  ExpressionPtr asked = made(Expression::Kind::constant, type("bool"), place(), "true"), step;
  if (take("while")) {
    asked = truth(in_brackets());
  } else {
    want("for");
    want("(");
    if (!take(";")) first = begins_declaration() ? declared() : statement();
    if (!at(";")) asked = truth(condition());
    want(";");
    if (!at(")")) step = expression();
    want(")");
  }
  s->expressions.push_back(std::move(asked));
  if (step) s->expressions.push_back(std::move(step));
  s->body.push_back(std::move(first));
  s->body.push_back(statement());
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
  const std::string named = name("a variable");
  want(",");
  s->expressions.push_back(converted(condition(), type));
  want(")");
  s->variables.push_back(declare(named, type, where));
  s->body.push_back(statement());
  return s;
}

StatementPtr Parser::given() {
  StatementPtr s = made(Statement::Kind::give);
  want("return");
  const Type& wanted = function_->result;
  if (wanted.is_nothing() != at(";")) fail(place(), "'{}' gives {}", function_->name, name_of(wanted));
  if (!at(";")) s->expressions.push_back(converted(condition(), wanted));
  want(";");
  return s;
}

}  // namespace sundog::spmd
