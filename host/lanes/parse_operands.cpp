// Operands: names, numbers, calls, and what stands behind them.
#include "lanes/parser.h"

namespace sundog::spmd {

using Kind = Expression::Kind;

ExpressionPtr Parser::postfix(ExpressionPtr of) {
  for (;;) {
    const Token sign = word();
    if (take(".") || take("->")) {
      of = part_of(of, sign.is("->"));
    } else if (take("[")) {
      const ExpressionPtr index = condition();
      want("]");
      if (!of->type.is_pointer() && !of->type.is_array())
        fail(sign.place, "'[' behind {}", name_of(of->type));
      if (!index->type.is_whole()) fail(sign.place, "an index that is {}", name_of(index->type));
      const Space space = of->type.space;
      of = made(Kind::index, *of->type.of, sign.place, "", of, index);
      of->type.space = space;
    } else if (take("++") || take("--")) {
      of = stepped(sign, of, true);
    } else {
      return of;
    }
  }
}

ExpressionPtr Parser::part_of(ExpressionPtr of, bool arrow) {
  const Place where = place();
  const std::string wanted = name("a member");
  if (arrow != of->type.is_pointer()) fail(where, "'{}' behind {}", arrow ? "->" : ".", name_of(of->type));
  const Type& whole = arrow ? *of->type.of : of->type;
  if (whole.is_vector()) {
    const std::string_view known =
        std::string_view("xyzw").substr(0, static_cast<std::size_t>(whole.form->parts));
    if (wanted.size() > 4 || wanted.find_first_not_of(known) != std::string::npos)
      fail(where, "a {} has no '{}'", whole.name, wanted);
    const Type& part = scalar(whole.part);
    const Type& found = wanted.size() == 1 ? part : type(part.name + std::to_string(wanted.size()));
    return made(Kind::component, found, where, wanted, of);
  }
  if (!whole.is_structure()) fail(where, "{} has no members", name_of(whole));
  const Member* member = whole.structure->member(wanted);
  if (!member) fail(where, "a {} has no '{}'", whole.name, wanted);
  const ExpressionPtr e = made(Kind::member, member->type, where, wanted, of);
  if (!e->type.is_pointer()) e->type.space = of->type.space;
  e->arrow = arrow;
  return e;
}

ExpressionPtr Parser::primary() {
  if (word().kind == Token::Kind::number) return number();
  if (at_name()) return named();
  fail(place(), "'{}' begins no expression", word().text);
}

ExpressionPtr Parser::number() {
  const Token token = tokens_[at_++];
  const std::string& text = token.text;
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  const bool has_point = text.find_first_of(hex ? ".pP" : ".eE") != std::string::npos;
  const char last = static_cast<char>(std::tolower(text.back()));
  if (has_point && last != 'f') fail(token.place, "{} is a double: write {}f", text, text);
  const bool natural = last == 'u' || (hex && std::stoull(text, nullptr, 16) > 0x7FFFFFFFull);
  const ExpressionPtr e = made(Kind::number,
                               type(has_point ? "float"
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
  for (const auto& scope : scopes_)
    if (const auto found = scope.find(token.text); found != scope.end()) {
      const ExpressionPtr e = made(Kind::variable, found->second->type, token.place, token.text);
      e->variable = found->second;
      return e;
    }
  if (const auto known = constants_.find(token.text); known != constants_.end())
    return made(Kind::constant, known->second, token.place, token.text);
  const bool is_truth = token.is("true") || token.is("false");
  if (!is_truth && !token.text.starts_with("HAS_"))
    fail(token.place, "'{}' is not known: a constant of hand-written code is declared by CONSTANT",
         token.text);
  return made(Kind::constant, type(is_truth ? "bool" : "int"), token.place, token.text);
}

std::vector<ExpressionPtr> Parser::arguments() {
  std::vector<ExpressionPtr> all;
  want("(");
  list_until(")", [&] { all.push_back(condition()); });
  return all;
}

ExpressionPtr Parser::call(const Token& called) {
  if (called.is("any")) return made(Kind::any, type("bool"), called.place, "", truth(in_brackets()));
  const std::vector<ExpressionPtr> given = arguments();
  const auto found = out_.function_of.find(called.text);
  if (found == out_.function_of.end()) return built_in(called, given);
  const Function& f = *found->second;
  if (&f == function_) fail(called.place, "'{}' calls itself", f.name);
  if (given.size() != f.taken.size())
    fail(called.place, "'{}' takes {} arguments, found {}", f.name, f.taken.size(), given.size());
  const ExpressionPtr e = made(Kind::call, f.result, called.place, f.name);
  e->function = &f;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Type &type = f.taken[i]->type, &own = given[i]->type;
    if (type.is_pointer() && (own.is_pointer() || own.is_array())) {
      const Type &to = *type.of, &from = *own.of;
      const bool same = to.kind == from.kind && to.structure == from.structure && to.form == from.form;
      if (!same || (own.is_pointer() && type.space != own.space))
        fail(given[i]->place, "'{}' wants {}, found {}", f.taken[i]->name, name_of(type), name_of(own));
    }
    e->of.push_back(converted(given[i], type));
  }
  return e;
}

ExpressionPtr Parser::built_in(const Token& called, std::vector<ExpressionPtr> given) const {
  using T = Type::Kind;
  const BuiltIn* f = built_in_of(called.text);
  const bool whole =
      std::ranges::all_of(given, [](const auto& e) { return e->type.is_whole() || e->type.is_truth(); });
  if (!f || (f->takes == T::integer && !whole))
    fail(called.place, "there is no function '{}' for lanes", called.text);
  if (given.size() != f->arguments)
    fail(called.place, "'{}' takes {} arguments, found {}", called.text, f->arguments, given.size());
  T takes = f->takes, gives = f->gives;
  if (whole && (takes == T::integer || called.is("clamp")))
    takes = gives = std::ranges::any_of(given, [](const auto& e) { return e->type.is_natural(); })
                        ? T::natural
                        : T::integer;
  for (ExpressionPtr& e : given) {
    if (takes != T::nothing || e->type.is_truth())
      e = converted(e, scalar(takes != T::nothing ? takes : T::integer));
    else if (!e->type.is_number())
      fail(e->place, "'{}' of {}", called.text, name_of(e->type));
  }
  const ExpressionPtr e = made(Kind::call, scalar(gives), called.place, called.text);
  e->of = std::move(given);
  return e;
}

ExpressionPtr Parser::initial(const Type& type) {
  return at("{") ? list(type) : converted(condition(), type);
}

ExpressionPtr Parser::list(const Type& type) {
  const ExpressionPtr e = made(Kind::list, type, place());
  std::vector<Type> wanted;
  if (type.is_array()) wanted.assign(static_cast<std::size_t>(type.length), *type.of);
  if (type.is_structure())
    for (const Member& m : type.structure->members) {
      wanted.push_back(m.type);
      if (!m.feature.empty())
        fail(place(), "a list for a {}, some of whose members come with features", type.name);
    }
  want("{");
  list_until("}", [&] {
    if (e->of.size() == wanted.size()) fail(place(), "{} has {} parts", name_of(type), wanted.size());
    e->of.push_back(initial(wanted[e->of.size()]));
  });
  if (e->of.size() != wanted.size()) fail(e->place, "a list of {} for {} parts", e->of.size(), wanted.size());
  return e;
}

}  // namespace sundog::spmd
