// Operands: names, numbers, calls, and what stands behind them.
#include <fmt/format.h>

#include <algorithm>

#include "lanes/parser.h"

namespace sundog::spmd {

using Kind = Expression::Kind;

ExpressionPtr Parser::postfix(ExpressionPtr of) {
  for (;;) {
    if (at(".") || at("->")) {
      const bool arrow = at("->");
      ++at_;
      of = part_of(std::move(of), arrow);
    } else if (at("[")) {
      const Place where = place();
      want("[");
      ExpressionPtr index = condition();
      want("]");
      if (!of->type.is(Type::Kind::pointer) && !of->type.is(Type::Kind::array))
        fail(where, fmt::format("'[' behind {}", name_of(of->type)));
      if (!index->type.is_whole()) fail(where, fmt::format("an index that is {}", name_of(index->type)));
      ExpressionPtr e = made(Kind::index, *of->type.of, where);
      e->type.space = of->type.space;
      e->of.push_back(std::move(of));
      e->of.push_back(std::move(index));
      of = std::move(e);
    } else if (at("++") || at("--")) {
      if (!of->type.is_whole() && !of->type.is(Type::Kind::real))
        fail(place(), fmt::format("'{}' of {}", word().text, name_of(of->type)));
      ExpressionPtr e = made(Kind::unary, of->type, place());
      e->text = word().text;
      e->postfix = true;
      ++at_;
      e->of.push_back(std::move(of));
      of = std::move(e);
    } else {
      return of;
    }
  }
}

ExpressionPtr Parser::part_of(ExpressionPtr of, bool arrow) {
  const Place where = place();
  const std::string wanted = name("a member");
  if (arrow != of->type.is(Type::Kind::pointer))
    fail(where, fmt::format("'{}' behind {}", arrow ? "->" : ".", name_of(of->type)));
  const Type& whole = arrow ? *of->type.of : of->type;
  const Space space = of->type.space;
  if (whole.is(Type::Kind::vector)) {
    const bool known =
        whole.form->parts > 0 && wanted.size() <= 4 && std::ranges::all_of(wanted, [&](char c) {
          const std::size_t part = std::string_view("xyzw").find(c);
          return part < static_cast<std::size_t>(whole.form->parts);
        });
    if (!known) fail(where, fmt::format("a {} has no '{}'", whole.name, wanted));
    const Type& part = part_type(whole);
    const Type type = wanted.size() == 1 ? part : types_.at(part.name + std::to_string(wanted.size()));
    ExpressionPtr e = made(Kind::component, type, where);
    e->text = wanted;
    e->of.push_back(std::move(of));
    return e;
  }
  if (!whole.is(Type::Kind::structure)) fail(where, fmt::format("{} has no members", name_of(whole)));
  const Member* member = whole.structure->member(wanted);
  if (!member) fail(where, fmt::format("a {} has no '{}'", whole.name, wanted));
  ExpressionPtr e = made(Kind::member, member->type, where);
  if (!e->type.is(Type::Kind::pointer)) e->type.space = space;
  e->text = wanted;
  e->arrow = arrow;
  e->of.push_back(std::move(of));
  return e;
}

ExpressionPtr Parser::primary() {
  if (word().kind == Token::Kind::number) return number();
  if (word().kind == Token::Kind::name) return named();
  fail(place(), fmt::format("'{}' begins no expression", word().text));
}

ExpressionPtr Parser::number() {
  const Token token = tokens_[at_++];
  const std::string& text = token.text;
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  const bool has_point = text.find('.') != std::string::npos ||
                         (!hex && text.find_first_of("eE") != std::string::npos) ||
                         (hex && text.find_first_of("pP") != std::string::npos);
  const char last = text.back();
  const bool is_large = hex && !has_point && std::stoull(text, nullptr, 16) > 0x7FFFFFFFull;
  if (has_point && last != 'f' && last != 'F')
    fail(token.place, fmt::format("{} is a double: write {}f", text, text));
  const bool natural = is_large || (!has_point && (last == 'u' || last == 'U'));
  ExpressionPtr e = made(Kind::number,
                         types_.at(has_point ? "float"
                                   : natural ? "uint"
                                             : "int"),
                         token.place);
  e->text = token.macro.empty() ? text : token.macro;
  e->digits = text;
  return e;
}

ExpressionPtr Parser::named() {
  const Token token = tokens_[at_++];
  if (at("(")) return call(token);
  for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
    if (const auto found = scope->find(token.text); found != scope->end()) {
      ExpressionPtr e = made(Kind::variable, found->second->type, token.place);
      e->variable = found->second;
      e->text = token.text;
      return e;
    }
  Type type = types_.at("int");
  if (token.is("true") || token.is("false"))
    type = types_.at("bool");
  else if (const auto known = constants_.find(token.text); known != constants_.end())
    type = known->second;
  else if (!token.text.starts_with("HAS_"))
    fail(token.place,
         fmt::format("'{}' is not known: a constant of hand-written code is declared by CONSTANT",
                     token.text));
  ExpressionPtr e = made(Kind::constant, type, token.place);
  e->text = token.text;
  return e;
}

std::vector<ExpressionPtr> Parser::arguments() {
  std::vector<ExpressionPtr> all;
  want("(");
  while (!take(")")) {
    all.push_back(condition());
    if (!at(")")) want(",");
  }
  return all;
}

ExpressionPtr Parser::call(const Token& called) {
  std::vector<ExpressionPtr> given = arguments();
  if (called.is("any")) {
    if (given.size() != 1) fail(called.place, "any() takes one condition");
    ExpressionPtr e = made(Kind::any, types_.at("bool"), called.place);
    e->of.push_back(truth(std::move(given[0])));
    return e;
  }
  const auto found = out_.function_of.find(called.text);
  if (found == out_.function_of.end()) return built_in(called, std::move(given));
  const Function& f = *found->second;
  if (&f == function_) fail(called.place, fmt::format("'{}' calls itself", f.name));
  const std::vector<const Variable*> wanted = taken(f);
  if (given.size() != wanted.size())
    fail(called.place, fmt::format("'{}' takes {} arguments, found {}", f.name, wanted.size(), given.size()));
  ExpressionPtr e = made(Kind::call, f.result, called.place);
  e->function = &f;
  e->text = f.name;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Type& type = wanted[i]->type;
    const Type& own = given[i]->type;
    if (type.is(Type::Kind::pointer) && (own.is(Type::Kind::pointer) || own.is(Type::Kind::array))) {
      const Type &to = *type.of, &from = *own.of;
      const bool same = to.kind == from.kind && to.structure == from.structure && to.form == from.form;
      if (!same || (own.is(Type::Kind::pointer) && type.space != own.space))
        fail(given[i]->place,
             fmt::format("'{}' wants {}, found {}", wanted[i]->name, name_of(type), name_of(own)));
    }
    e->of.push_back(converted(std::move(given[i]), type));
  }
  return e;
}

/// OpenCL's functions of single numbers.
ExpressionPtr Parser::built_in(const Token& called, std::vector<ExpressionPtr> given) {
  static const std::map<std::string, std::size_t> of_reals{
      {"fma", 3},  {"mad", 3},   {"sqrt", 1},     {"rsqrt", 1}, {"fabs", 1},  {"floor", 1},
      {"ceil", 1}, {"trunc", 1}, {"round", 1},    {"rint", 1},  {"sin", 1},   {"cos", 1},
      {"tan", 1},  {"asin", 1},  {"acos", 1},     {"atan", 1},  {"atan2", 2}, {"exp", 1},
      {"exp2", 1}, {"log", 1},   {"log2", 1},     {"pow", 2},   {"fmin", 2},  {"fmax", 2},
      {"fmod", 2}, {"cbrt", 1},  {"copysign", 2}, {"sinpi", 1}, {"cospi", 1}, {"step", 2},
      {"mix", 3},  {"sign", 1},  {"clamp", 3},    {"cosh", 1},  {"sinh", 1},  {"tanh", 1}};
  static const std::map<std::string, std::size_t> of_wholes{{"min", 2}, {"max", 2}, {"clamp", 3}};
  static const std::map<std::string, std::pair<std::string, std::string>> casts{
      {"as_int", {"", "int"}},
      {"as_uint", {"", "uint"}},
      {"as_float", {"", "float"}},
      {"convert_float", {"", "float"}},
      {"convert_int_rtz", {"float", "int"}},
      {"convert_uint_rtz", {"float", "uint"}}};
  Type type;
  std::size_t wanted = 1;
  const bool whole = !given.empty() && std::ranges::all_of(given, [](const ExpressionPtr& e) {
    return e->type.is_whole() || e->type.is(Type::Kind::boolean);
  });
  if (const auto found = casts.find(called.text); found != casts.end()) {
    type = types_.at(found->second.second);
    if (!given.empty() && !found->second.first.empty())
      given[0] = converted(std::move(given[0]), types_.at(found->second.first));
    if (!given.empty() && given[0]->type.is(Type::Kind::boolean))
      given[0] = converted(std::move(given[0]), types_.at("int"));
  } else if (const auto wholes = of_wholes.find(called.text); whole && wholes != of_wholes.end()) {
    wanted = wholes->second;
    const bool natural =
        std::ranges::any_of(given, [](const ExpressionPtr& e) { return e->type.is(Type::Kind::natural); });
    type = types_.at(natural ? "uint" : "int");
    for (ExpressionPtr& e : given) e = converted(std::move(e), type);
  } else if (const auto reals = of_reals.find(called.text); reals != of_reals.end()) {
    wanted = reals->second;
    type = types_.at("float");
    for (ExpressionPtr& e : given) e = converted(std::move(e), type);
  } else {
    fail(called.place, fmt::format("there is no function '{}' for lanes", called.text));
  }
  if (given.size() != wanted)
    fail(called.place, fmt::format("'{}' takes {} arguments, found {}", called.text, wanted, given.size()));
  ExpressionPtr e = made(Kind::call, type, called.place);
  e->text = called.text;
  e->of = std::move(given);
  return e;
}

ExpressionPtr Parser::initial(const Type& type) {
  return at("{") ? list(type) : converted(condition(), type);
}

ExpressionPtr Parser::list(const Type& type) {
  ExpressionPtr e = made(Kind::list, type, place());
  if (type.is(Type::Kind::structure))
    for (const Member& m : type.structure->members)
      if (!m.feature.empty())
        fail(place(), fmt::format("a list for a {}, some of whose members come with features", type.name));
  want("{");
  std::size_t i = 0;
  for (; !take("}"); ++i) {
    const bool of_structure = type.is(Type::Kind::structure);
    if (!of_structure && !type.is(Type::Kind::array))
      fail(place(), fmt::format("a list for {}", name_of(type)));
    if (of_structure && i >= type.structure->members.size())
      fail(place(), fmt::format("{} has {} members", type.name, type.structure->members.size()));
    e->of.push_back(initial(of_structure ? type.structure->members[i].type : *type.of));
    if (!at("}")) want(",");
  }
  const std::size_t all =
      type.is(Type::Kind::structure) ? type.structure->members.size() : static_cast<std::size_t>(type.length);
  if (i != all) fail(e->place, fmt::format("a list of {} for {} parts", i, all));
  return e;
}

}  // namespace sundog::spmd
