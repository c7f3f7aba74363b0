// Parses declarations outside functions: structures, constants, function heads.
#include "lanes/parser.h"

namespace sundog::spmd {
namespace {

Type made_type(Type::Kind kind, const std::string& name) {
  Type t;
  t.kind = kind;
  t.name = name;
  return t;
}

}  // namespace

Parser::Parser(const Source& source, const IsPlain& is_plain) : tokens_(source.tokens), is_plain_(is_plain) {
  using enum Type::Kind;
  types_["void"] = made_type(nothing, "void");
  types_["bool"] = made_type(boolean, "bool");
  types_["u32"] = made_type(natural, "u32");
  const std::pair<const char*, Type::Kind> numbers[] = {{"float", real}, {"int", integer}, {"uint", natural}};
  for (const auto& [number, kind] : numbers) {
    types_[number] = made_type(kind, number);
    for (int n = 2; n <= 4; ++n) {
      Type t = made_type(vector, fmt::format("{}{}", number, n));
      const std::string lanes = kind == real ? fmt::format("REAL{}", n) : "";
      t.form = &out_.forms.emplace_back(VectorForm{t.name, lanes, "", n});
      t.part = kind;
      types_[t.name] = t;
    }
  }
  types_["i32"] = types_["int"];
  for (const char* name :
       {"INFINITY", "MAXFLOAT", "FLT_MIN", "FLT_MAX", "FLT_EPSILON", "M_PI_F", "M_1_PI_F", "M_PI_2_F", "NAN"})
    constants_[name] = types_["float"];
}

Program Parser::program() {
  while (word().kind != Token::Kind::end) declaration();
  for (const Function& f : out_.functions)
    if (f.is_entry && !f.body) fail(f.place, "ENTRY of '{}', which has no text", f.name);
  return std::move(out_);
}

const Token& Parser::word(std::size_t ahead) const {
  return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
}
bool Parser::take(std::string_view text) {
  if (!at(text)) return false;
  ++at_;
  return true;
}
void Parser::want(std::string_view text) {
  if (!take(text)) fail(place(), "wanted '{}', found '{}'", text, word().text);
}
std::string Parser::name(std::string_view what) {
  if (!at_name()) fail(place(), "wanted the name of {}, found '{}'", what, word().text);
  return tokens_[at_++].text;
}
std::string Parser::name_in_brackets(std::string_view what) {
  want("(");
  std::string found = name(what);
  want(")");
  return found;
}

/// From an opening bracket to behind the one that closes it.
void Parser::skip_brackets() {
  const Place from = place();
  int depth = 0;
  do {
    if (word().kind == Token::Kind::end) fail(from, "a bracket has no end");
    if (at("(") || at("{") || at("[")) ++depth;
    if (at(")") || at("}") || at("]")) --depth;
    ++at_;
  } while (depth > 0);
}

void Parser::declaration() {
  if (take(";")) return;
  if (at("HAVING") && word(4).is(";")) {
    const std::string* file = place().file;
    ++at_;
    features_[file] = name_in_brackets("a feature");
  } else if (take("LANE_VECTOR")) {
    vector_definition();
  } else if (at("enum")) {
    enumeration();
  } else if (take("CONSTANT")) {
    const Type type = base_type();
    constants_[name("a constant")] = type;
  } else if (take("typedef")) {
    type_definition();
  } else {
    return function();
  }
  want(";");
}

void Parser::type_definition() {
  if (at("enum")) {
    enumeration();
    types_[name("a type")] = types_["uint"];
  } else if (at("struct")) {
    structure();
  } else {
    const Type type = pointed(base_type());
    types_.try_emplace(name("a type"), type);
  }
}

void Parser::vector_definition() {
  VectorForm form;
  want("(");
  form.name = name("a vector");
  want(",");
  form.lanes = name("its lane form");
  want(",");
  form.prefix = name("its functions");
  want(",");
  form.parts = std::stoi(number()->digits);
  want(")");
  Type& t = types_[form.name] = made_type(Type::Kind::vector, form.name);
  t.form = &out_.forms.emplace_back(form);
}

void Parser::enumeration() {
  want("enum");
  if (at_name()) ++at_;
  want("{");
  list_until("}", [&] {
    constants_[name("a constant")] = types_["int"];
    while (!at(",") && !at("}")) ++at_;
  });
}

/// `struct [name] [LANES(name, join)] { members } name`
void Parser::structure() {
  Structure s;
  s.place = place();
  want("struct");
  if (at_name() && !at("LANES")) ++at_;
  s.by_hand = take("LANES");
  if (s.by_hand) {
    want("(");
    s.lanes = name("a lane form");
    if (take(",")) s.join = name("what joins lanes");
    want(")");
  }
  members(s);
  s.name = name("a type");
  s.shared = !is_plain_(*s.place.file);
  if (s.lanes.empty()) s.lanes = s.name + "s";
  if (types_.contains(s.name)) fail(s.place, "there is a type '{}' already", s.name);
  Type& t = types_[s.name] = made_type(Type::Kind::structure, s.name);
  t.structure = &out_.structures.emplace_back(std::move(s));
}

void Parser::members(Structure& s) {
  want("{");
  while (!take("}")) {
    Member member;
    if (take("HAVING")) member.feature = name_in_brackets("a feature");
    member.uniform = take("UNIFORM");
    const Type base = base_type();
    do {
      member.type = pointed(base);
      member.name = name("a member");
      member.type = lengthened(member.type);
      s.members.push_back(member);
    } while (take(","));
    want(";");
  }
}

Type Parser::base_type() {
  bool constant = false, global = false;
  for (;;) {
    if (take("const"))
      constant = true;
    else if (take("__global"))
      global = true;
    else
      break;
  }
  const auto known = types_.find(word().text);
  if (known == types_.end()) fail(place(), "'{}' is no type", word().text);
  ++at_;
  Type type = known->second;
  type.constant = constant;
  type.global = global;
  return type;
}

Type Parser::pointed(Type type) {
  while (take("*")) {
    if (type.is_pointer()) fail(place(), "a pointer to a pointer");
    type = pointer_to(type);
    while (take("const") || take("restrict")) {
    }
  }
  return type;
}

Type Parser::lengthened(Type type) {
  if (!take("[")) return type;
  const Place where = place();
  const ExpressionPtr length = condition();
  want("]");
  if (length->kind != Expression::Kind::number) fail(where, "the length of an array is a number");
  return array_of(lengthened(std::move(type)), std::stoi(length->digits, nullptr, 0));
}

void Parser::function() {
  Function f;
  f.feature = features_[place().file];
  for (;;) {
    if (take("inline"))
      f.is_inline = true;
    else if (take("ENTRY"))
      f.is_entry = true;
    else if (take("UNIFORM"))
      f.uniform = true;
    else if (take("HAVING"))
      f.feature += (f.feature.empty() ? "" : " && ") + name_in_brackets("a feature");
    else if (take("CALLED"))
      f.lanes = name_in_brackets("a function");
    else if (!take("static") && !take("NEVER_INLINE"))
      break;
  }
  f.result = pointed(base_type());
  f.result.constant = false;
  f.place = place();
  f.name = name("a function");
  if (f.lanes.empty()) f.lanes = f.name;
  known_.clear();
  want("(");
  if (at("void") && word(1).is(")")) ++at_;
  list_until(")", [&] { parameter(f); });
  const bool plain = is_plain_(*f.place.file);
  f.uniform |= !plain;
  Function& kept = out_.functions.emplace_back(std::move(f));
  const Function*& known = out_.function_of[kept.name];  // a prototype may stand before the text
  if (known && (known->body || !at("{"))) fail(kept.place, "'{}' is there already", kept.name);
  known = &kept;
  if (!at("{")) return want(";");
  if (!plain) return skip_brackets();
  function_ = &kept;
  kept.body = block();
}

void Parser::parameter(Function& f) {
  Variable v;
  v.place = place();
  v.here = take("HERE");
  if (!v.here) {
    v.uniform = take("UNIFORM");
    const Type type = pointed(base_type());
    v.name = name("a parameter");
    v.type = lengthened(type);
    if (v.type.is_array()) v.type = pointer_to(*v.type.of);  // as C hands it over
  }
  const Variable& kept = out_.variables.emplace_back(std::move(v));
  f.parameters.push_back(&kept);
  f.takes_mask |= kept.here;
  if (kept.here) return;
  f.taken.push_back(&kept);
  known_.push_back(&kept);
}

}  // namespace sundog::spmd
