// Parses expressions with their types; OpenCL's implicit conversions become nodes of the tree.
#include <set>

#include "lanes/parser.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

bool is_assignment(std::string_view sign) { return sign.ends_with('=') && !compares(sign); }

/// The precedence of a binary operator, 0 for other tokens.
int strength_of(const std::string& sign) {
  static const auto& strengths = *new const std::map<std::string, int>{
      {"||", 1}, {"&&", 2}, {"|", 3},  {"^", 4},  {"&", 5}, {"==", 6}, {"!=", 6}, {"<", 7},  {">", 7},
      {"<=", 7}, {">=", 7}, {"<<", 8}, {">>", 8}, {"+", 9}, {"-", 9},  {"*", 10}, {"/", 10}, {"%", 10}};
  const auto found = strengths.find(sign);
  return found == strengths.end() ? 0 : found->second;
}

}  // namespace

const Type& Parser::scalar(Type::Kind kind) const {
  return type(kind == Type::Kind::real ? "float" : kind == Type::Kind::integer ? "int" : "uint");
}

/// Converts `e` to `type` by C's implicit conversions.
ExpressionPtr Parser::converted(ExpressionPtr e, const Type& type) const {
  const Type& own = e->type;
  if (own.fits(type)) return e;
  if (!own.is_number() || (!type.is_vector() && !type.is_number()))
    fail(e->place, "wanted {}, found {}", name_of(type), name_of(own));
  if (type.is_vector()) e = converted(e, this->type("float"));
  const ExpressionPtr cast = made(Kind::cast, type, e->place, "", e);
  cast->implicit = true;
  return cast;
}

ExpressionPtr Parser::truth(ExpressionPtr e) const {
  if (!e->type.is_number()) fail(e->place, "{} is no condition", name_of(e->type));
  return converted(std::move(e), type("bool"));
}

ExpressionPtr Parser::expression() {
  const ExpressionPtr to = conditional();
  if (!is_assignment(word().text)) {
    refuse_steps(to->steps() ? *to->of[0] : *to);
    return to;
  }
  refuse_steps(*to);
  Token sign = tokens_[at_++];
  ExpressionPtr value = condition();
  if (is_assignment(word().text)) fail(place(), "one assignment at a time");
  if (!sign.is("=")) {
    sign.text.pop_back();
    value = combined(sign, to, value);
  }
  return made(Kind::assign, to->type, sign.place, "", to, converted(value, to->type));
}

/// Refuses ++ and -- within expressions, where the order of lanes would matter.
void Parser::refuse_steps(const Expression& e) const {
  any_within(e, [](const Expression& part) -> bool {
    if (!part.steps()) return false;
    fail(part.place, "'{}' within an expression: write it as a statement", part.text);
  });
}

ExpressionPtr Parser::condition() {
  ExpressionPtr e = conditional();
  refuse_steps(*e);
  return e;
}

ExpressionPtr Parser::in_brackets() {
  want("(");
  ExpressionPtr e = condition();
  want(")");
  return e;
}

ExpressionPtr Parser::conditional() {
  ExpressionPtr asked = binary(0);
  const Place where = place();
  if (!take("?")) return asked;
  const ExpressionPtr a = condition();
  want(":");
  const ExpressionPtr b = condition();
  const Type& wider = a->type.kind >= b->type.kind ? a->type : b->type;
  return made(Kind::choose, wider, where, "", truth(asked), converted(a, wider), converted(b, wider));
}

ExpressionPtr Parser::binary(int least) {
  ExpressionPtr a = unary();
  while (strength_of(word().text) > least) {
    const Token sign = tokens_[at_++];
    a = combined(sign, a, binary(strength_of(sign.text)));
  }
  return a;
}

ExpressionPtr Parser::combined(const Token& sign, ExpressionPtr a, ExpressionPtr b) const {
  Type type = a->type;
  const auto refuse = [&] {
    fail(sign.place, "'{}' of {} and {}", sign.text, name_of(a->type), name_of(b->type));
  };
  if (joins(sign.text)) {
    a = truth(a);
    b = truth(b);
  } else if (a->type.is_vector() || b->type.is_vector()) {
    if (std::string_view("+-*/").find(sign.text) == std::string_view::npos) refuse();
    if (b->type.is_vector()) type = a->type.is_vector() ? a->type : b->type;
    a = converted(a, type);
    b = converted(b, type);
  } else if (!a->type.is_table() || !b->type.is_whole() || !sign.is("+")) {
    if (!a->type.is_number() || !b->type.is_number()) refuse();
    const bool shifts = sign.is("<<") || sign.is(">>");
    if (shifts && b->type.is_real()) fail(sign.place, "a shift by a float");
    // As in C, int wins over bool, unsigned over int, and float over all.
    if (!shifts && b->type.kind > type.kind) type = b->type;
    if (type.is_truth()) type = this->type("int");
    a = converted(a, type);
    if (!shifts || b->type.is_truth()) b = converted(b, type);
  }
  const bool is_truth = joins(sign.text) || compares(sign.text);
  return made(Kind::binary, is_truth ? this->type("bool") : type, sign.place, sign.text, a, b);
}

ExpressionPtr Parser::unary() {
  const Token sign = word();
  if (sign.kind == Token::Kind::number) return postfix(number());
  if (at_name()) return postfix(named());
  if (sign.is("(")) return cast_or_brackets();
  static const auto& known = *new const std::set<std::string_view>{"-", "!", "~", "*", "&", "++", "--"};
  if (!known.contains(sign.text)) fail(sign.place, "'{}' begins no expression", sign.text);
  ++at_;
  ExpressionPtr of = unary();
  if (sign.text.size() == 2) return stepped(sign, of, false);
  if (sign.is("!")) of = truth(of);
  if ((sign.is("-") || sign.is("~")) && of->type.is_truth()) of = converted(of, type("int"));
  if (sign.is("*") && !of->type.is_pointer()) fail(sign.place, "'*' of {}", name_of(of->type));
  const Type type = sign.is("*") ? *of->type.of : sign.is("&") ? pointer_to(of->type) : of->type;
  return made(Kind::unary, type, sign.place, sign.text, of);
}

ExpressionPtr Parser::stepped(const Token& sign, ExpressionPtr of, bool postfix) const {
  if (!of->type.is_whole() && !of->type.is_real())
    fail(sign.place, "'{}' of {}", sign.text, name_of(of->type));
  const ExpressionPtr e = made(Kind::unary, of->type, sign.place, sign.text, of);
  e->postfix = postfix;
  return e;
}

ExpressionPtr Parser::cast_or_brackets() {
  const Place where = place();
  want("(");
  if (!begins_type()) {
    const ExpressionPtr inner = condition();
    want(")");
    return postfix(inner);
  }
  const Type type = pointed(base_type());
  want(")");
  if (type.is_vector() && at("(")) return postfix(vector_of(type, where));
  const ExpressionPtr of = unary();
  if (!of->type.is_number() || !type.is_number())
    fail(where, "a cast of {} to {}", name_of(of->type), name_of(type));
  return of->type.is(type.kind) ? of : made(Kind::cast, type, where, "", of);
}

ExpressionPtr Parser::vector_of(const Type& type, const Place& where) {
  const ExpressionPtr e = made(Kind::vector, type, where);
  int parts = 0;
  for (const ExpressionPtr& given : arguments()) {
    const bool is_vector = given->type.is_vector();
    parts += is_vector ? given->type.form->parts : 1;
    e->of.push_back(is_vector ? given : converted(given, this->type("float")));
  }
  if (parts == 1) return converted(e->of[0], type);
  if (parts != type.form->parts || !type.form->prefix.empty())
    fail(where, "a {} of {} parts", type.name, parts);
  return e;
}

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
      const bool global = of->type.global;
      of = made(Kind::index, *of->type.of, sign.place, "", of, index);
      of->type.global = global;
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
    const Type& found = type(wanted.size() == 1 ? "float" : fmt::format("float{}", wanted.size()));
    return made(Kind::component, found, where, wanted, of);
  }
  if (!whole.is_structure()) fail(where, "{} has no members", name_of(whole));
  const Member* member = whole.structure->member(wanted);
  if (!member) fail(where, "a {} has no '{}'", whole.name, wanted);
  const ExpressionPtr e = made(Kind::member, member->type, where, wanted, of);
  if (!e->type.is_pointer()) e->type.global = of->type.global;
  e->arrow = arrow;
  return e;
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
  if (const auto own = std::ranges::find(known_, token.text, &Variable::name); own != known_.end()) {
    const ExpressionPtr e = made(Kind::variable, (*own)->type, token.place, token.text);
    e->variable = *own;
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
  for (std::size_t i = 0; i < given.size(); ++i) e->of.push_back(converted(given[i], f.taken[i]->type));
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
