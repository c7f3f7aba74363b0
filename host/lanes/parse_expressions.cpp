// Expressions, with their types: OpenCL's conversions stand in the tree.
#include <fmt/format.h>

#include <algorithm>

#include "lanes/parser.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

bool is_assignment(const std::string& sign) {
  static const std::set<std::string> all{"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="};
  return all.contains(sign);
}

}  // namespace

int strength_of(const std::string& sign) {
  static const std::map<std::string, int> strengths{
      {"||", 1}, {"&&", 2}, {"|", 3},  {"^", 4},  {"&", 5}, {"==", 6}, {"!=", 6}, {"<", 7},  {">", 7},
      {"<=", 7}, {">=", 7}, {"<<", 8}, {">>", 8}, {"+", 9}, {"-", 9},  {"*", 10}, {"/", 10}, {"%", 10}};
  const auto found = strengths.find(sign);
  return found == strengths.end() ? 0 : found->second;
}

ExpressionPtr Parser::made(Kind kind, Type type, const Place& where) const {
  auto e = std::make_unique<Expression>();
  e->kind = kind;
  e->type = std::move(type);
  e->type.constant = false;
  e->place = where;
  return e;
}

/// The type of a vector's components.
const Type& Parser::part_type(const Type& vector) const {
  return types_.at(vector.part == Type::Kind::real      ? "float"
                   : vector.part == Type::Kind::integer ? "int"
                                                        : "uint");
}

/// `e` as a value of `type`, by the conversions that C makes by itself.
ExpressionPtr Parser::converted(ExpressionPtr e, const Type& type) const {
  const Type& own = e->type;
  if (own.kind == type.kind) {
    const bool same = own.is(Type::Kind::vector)      ? own.form == type.form
                      : own.is(Type::Kind::structure) ? own.structure == type.structure
                                                      : true;
    if (!same) fail(e->place, fmt::format("wanted {}, found {}", name_of(type), name_of(own)));
    return e;
  }
  if (type.is_table() && e->kind == Kind::number && e->text == "0") {  // none
    e->type = type;
    return e;
  }
  const bool spread = type.is(Type::Kind::vector) && own.is_number();
  if (!spread && !(own.is_number() && type.is_number()) &&
      !(own.is(Type::Kind::array) && type.is(Type::Kind::pointer)))
    fail(e->place, fmt::format("wanted {}, found {}", name_of(type), name_of(own)));
  if (own.is(Type::Kind::array)) return e;
  if (spread) e = converted(std::move(e), part_type(type));
  ExpressionPtr cast = made(Kind::cast, type, e->place);
  cast->implicit = true;
  cast->of.push_back(std::move(e));
  return cast;
}

ExpressionPtr Parser::truth(ExpressionPtr e) const {
  if (!e->type.is_number()) fail(e->place, fmt::format("{} is no condition", name_of(e->type)));
  return converted(std::move(e), types_.at("bool"));
}

ExpressionPtr Parser::expression() {
  ExpressionPtr to = conditional();
  if (!is_assignment(word().text)) {
    const bool steps = to->kind == Kind::unary && (to->text == "++" || to->text == "--");
    refuse_steps(steps ? *to->of[0] : *to);
    return to;
  }
  refuse_steps(*to);
  Token sign = tokens_[at_++];
  const Place where = sign.place;
  ExpressionPtr value = condition();
  if (is_assignment(word().text)) fail(place(), "one assignment at a time");
  if (!sign.is("=")) {
    sign.text.pop_back();
    value = combined(sign, copy_of(*to), std::move(value));
  }
  ExpressionPtr e = made(Kind::assign, to->type, where);
  value = converted(std::move(value), to->type);
  e->of.push_back(std::move(to));
  e->of.push_back(std::move(value));
  return e;
}

/// Steps stand by themselves: elsewhere the order in which lanes do them would matter.
void Parser::refuse_steps(const Expression& e) const {
  if (e.kind == Kind::unary && (e.text == "++" || e.text == "--"))
    fail(e.place, fmt::format("'{}' within an expression: write it as a statement", e.text));
  for (const ExpressionPtr& part : e.of) refuse_steps(*part);
}

ExpressionPtr Parser::condition() {
  ExpressionPtr e = conditional();
  refuse_steps(*e);
  return e;
}

ExpressionPtr Parser::conditional() {
  ExpressionPtr asked = binary(0);
  if (!at("?")) return asked;
  const Place where = place();
  want("?");
  ExpressionPtr a = condition();
  want(":");
  ExpressionPtr b = condition();
  // The wider of both types.
  const auto rank = [](const Type& t) { return t.is(Type::Kind::vector) ? 10 : static_cast<int>(t.kind); };
  const Type type = rank(a->type) >= rank(b->type) ? a->type : b->type;
  ExpressionPtr e = made(Kind::choose, type, where);
  e->of.push_back(truth(std::move(asked)));
  e->of.push_back(converted(std::move(a), type));
  e->of.push_back(converted(std::move(b), type));
  return e;
}

ExpressionPtr Parser::binary(int least) {
  ExpressionPtr a = unary();
  while (word().kind == Token::Kind::sign) {
    const int strength = strength_of(word().text);
    if (strength == 0 || strength <= least) break;
    const Token sign = tokens_[at_++];
    a = combined(sign, std::move(a), binary(strength));
  }
  return a;
}

ExpressionPtr Parser::combined(const Token& sign, ExpressionPtr a, ExpressionPtr b) {
  const Type &boolean = types_.at("bool"), &whole = types_.at("int");
  if (joins(sign.text)) {
    a = truth(std::move(a));
    b = truth(std::move(b));
  }
  Type type = a->type;
  if (a->type.is_table() && b->type.is_whole() && sign.is("+")) {
    type = a->type;
  } else if (a->type.is(Type::Kind::vector) || b->type.is(Type::Kind::vector)) {
    type = a->type.is(Type::Kind::vector) ? a->type : b->type;
    if (compares(sign.text) || std::string_view("+-*/").find(sign.text) == std::string_view::npos)
      fail(sign.place, fmt::format("'{}' of {} and {}", sign.text, name_of(a->type), name_of(b->type)));
    a = converted(std::move(a), type);
    b = converted(std::move(b), type);
  } else if (!joins(sign.text)) {
    if (!a->type.is_number() || !b->type.is_number())
      fail(sign.place, fmt::format("'{}' of {} and {}", sign.text, name_of(a->type), name_of(b->type)));
    // Truths are numbers; what is not negative wins over what may be; numbers with a point over both.
    type = a->type.kind >= b->type.kind ? a->type : b->type;
    if (type.is(Type::Kind::boolean)) type = whole;
    const bool shifts = sign.is("<<") || sign.is(">>");
    if (shifts && b->type.is(Type::Kind::boolean)) b = converted(std::move(b), whole);
    if (shifts && b->type.is(Type::Kind::real)) fail(sign.place, "a shift by a float");
    if ((a->type.is(Type::Kind::other) || b->type.is(Type::Kind::other)) && a->type.name != b->type.name)
      fail(sign.place,
           fmt::format("'{}' of {} and {}: cast them first", sign.text, name_of(a->type), name_of(b->type)));
    if (shifts) type = a->type.is(Type::Kind::boolean) ? whole : a->type;
    a = converted(std::move(a), type);
    if (!shifts) b = converted(std::move(b), type);
  }
  ExpressionPtr e = made(Kind::binary, joins(sign.text) || compares(sign.text) ? boolean : type, sign.place);
  e->text = sign.text;
  e->of.push_back(std::move(a));
  e->of.push_back(std::move(b));
  return e;
}

ExpressionPtr Parser::unary() {
  const Token sign = word();
  if (sign.kind != Token::Kind::sign) return postfix(primary());
  if (sign.is("(")) return cast_or_brackets();
  static const std::set<std::string> known{"-", "+", "!", "~", "*", "&", "++", "--"};
  if (!known.contains(sign.text)) fail(sign.place, fmt::format("'{}' begins no expression", sign.text));
  ++at_;
  ExpressionPtr of = unary();
  if (sign.is("!")) of = truth(std::move(of));
  Type type = of->type;
  const bool steps = sign.is("++") || sign.is("--");
  if (steps && !type.is_whole() && !type.is(Type::Kind::real))
    fail(sign.place, fmt::format("'{}' of {}", sign.text, name_of(type)));
  if ((sign.is("-") || sign.is("+") || sign.is("~")) && type.is(Type::Kind::boolean)) {
    of = converted(std::move(of), types_.at("int"));
    type = of->type;
  }
  if (sign.is("*")) {
    if (!type.is(Type::Kind::pointer)) fail(sign.place, fmt::format("'*' of {}", name_of(type)));
    type = Type(*type.of);
  }
  if (sign.is("&")) {
    Type pointer;
    pointer.kind = Type::Kind::pointer;
    pointer.of = std::make_shared<const Type>(type);
    pointer.space = type.space;
    type = pointer;
  }
  ExpressionPtr e = made(Kind::unary, type, sign.place);
  e->text = sign.text;
  e->of.push_back(std::move(of));
  return e;
}

ExpressionPtr Parser::cast_or_brackets() {
  const Place where = place();
  want("(");
  if (!begins_type()) {
    ExpressionPtr inner = condition();
    want(")");
    return postfix(std::move(inner));
  }
  const Type type = pointed(base_type());
  want(")");
  if (type.is(Type::Kind::vector) && at("(")) return postfix(vector_of(type, where));
  ExpressionPtr of = unary();
  if (!of->type.is_number() || !type.is_number())
    fail(where, fmt::format("a cast of {} to {}", name_of(of->type), name_of(type)));
  if (of->type.kind == type.kind) return of;
  ExpressionPtr e = made(Kind::cast, type, where);
  e->of.push_back(std::move(of));
  return e;
}

ExpressionPtr Parser::vector_of(Type type, const Place& where) {
  ExpressionPtr e = made(Kind::vector, type, where);
  int parts = 0;
  for (ExpressionPtr& given : arguments()) {
    parts += given->type.is(Type::Kind::vector) ? given->type.form->parts : 1;
    e->of.push_back(given->type.is(Type::Kind::vector) ? std::move(given)
                                                       : converted(std::move(given), part_type(type)));
  }
  if (parts == 1) return converted(std::move(e->of[0]), type);
  if (parts != type.form->parts || !type.form->prefix.empty())
    fail(where, fmt::format("a {} of {} parts", type.name, parts));
  return e;
}

}  // namespace sundog::spmd
