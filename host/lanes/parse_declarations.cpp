// Parses declarations outside functions: structures, constants, function heads.
#include "lanes/parser.h"

namespace sundog::spmd {

Parser::Parser(IsPlain is_plain) : is_plain_(std::move(is_plain)) {
  using enum Type::Kind;
  types_["void"] = {.kind = nothing, .name = "void"};
  types_["bool"] = {.kind = boolean, .name = "bool"};
  types_["u32"] = {.kind = natural, .name = "u32"};
  types_["float"] = {.kind = real, .name = "float"};
  types_["uint"] = {.kind = natural, .name = "uint"};
  types_["i32"] = types_["int"] = {.kind = integer, .name = "int"};
  for (int n = 2; n <= 4; ++n) add_vector({fmt::format("float{}", n), fmt::format("REAL{}", n), "", n});
  for (const char* name :
       {"INFINITY", "MAXFLOAT", "FLT_MIN", "FLT_MAX", "FLT_EPSILON", "M_PI_F", "M_1_PI_F", "M_PI_2_F", "NAN"})
    constants_[name] = types_["float"];
}

void Parser::add_vector(const VectorForm& form) {
  const VectorForm* kept = &out_.forms.emplace_back(form);
  types_[form.name] = {.kind = Type::Kind::vector, .name = form.name, .form = kept};
}

void Parser::read(Tokens tokens) {
  tokens_ = std::move(tokens);
  at_ = 0;
  while (word().kind != Token::Kind::end) declaration();
  for (const Function& f : out_.functions)
    if (f.is_entry && !f.body) fail(f.place, "ENTRY of '{}', which has no text", f.name);
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

/// Reads the words of `(name, 4, ...)`, at least `least`.
std::vector<std::string> Parser::words_in_brackets(std::size_t least) {
  std::vector<std::string> all;
  const Place where = place();
  want("(");
  list_until(")", [&] { all.push_back(tokens_[at_++].text); });
  if (all.size() < least) fail(where, "wanted {} words in brackets", least);
  return all;
}

/// Skips from an opening bracket past its closing one.
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
    features_[file] = words_in_brackets(1)[0];
  } else if (take("LANE_VECTOR")) {
    const std::vector<std::string> words = words_in_brackets(4);
    add_vector({words[0], words[1], words[2], std::atoi(words[3].c_str())});
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
  if (at("struct")) return structure();
  if (take("enum")) {
    if (at_name()) ++at_;
    want("{");
    list_until("}", [&] {
      constants_[name("a constant")] = types_["int"];
      while (!at(",") && !at("}")) ++at_;
    });
    types_[name("a type")] = types_["uint"];
  } else {
    const Type type = pointed(base_type());
    types_.try_emplace(name("a type"), type);
  }
}

/// `struct [name] [LANES(name, join)] { members } name`
void Parser::structure() {
  Structure s;
  s.place = place();
  want("struct");
  if (at_name() && !at("LANES")) ++at_;
  s.by_hand = take("LANES");
  if (s.by_hand) {
    const std::vector<std::string> words = words_in_brackets(1);
    s.lanes = words[0];
    if (words.size() > 1) s.join = words[1];
  }
  members(s);
  s.name = name("a type");
  s.shared = !is_plain_(*s.place.file);
  if (s.lanes.empty()) s.lanes = s.name + "s";
  if (types_.contains(s.name)) fail(s.place, "there is a type '{}' already", s.name);
  const Structure* kept = &out_.structures.emplace_back(s);
  types_[s.name] = {.kind = Type::Kind::structure, .name = s.name, .structure = kept};
}

void Parser::members(Structure& s) {
  want("{");
  while (!take("}")) {
    Member member;
    if (take("HAVING")) member.feature = words_in_brackets(1)[0];
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
  return {.kind = Type::Kind::array,
          .of = std::make_shared<const Type>(lengthened(std::move(type))),
          .length = std::stoi(length->digits, nullptr, 0)};
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
      f.feature += (f.feature.empty() ? "" : " && ") + words_in_brackets(1)[0];
    else if (take("CALLED"))
      f.lanes = words_in_brackets(1)[0];
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
  const Function*& known = out_.function_of[kept.name];  // a prototype may precede the definition
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
    v.out = take("OUT");
    const Type type = pointed(base_type());
    v.name = name("a parameter");
    v.type = lengthened(type);
    if (v.type.is_array()) v.type = pointer_to(*v.type.of);  // as C passes it
  }
  const Variable& kept = out_.variables.emplace_back(std::move(v));
  f.parameters.push_back(&kept);
  f.takes_mask |= kept.here;
  if (kept.here) return;
  f.taken.push_back(&kept);
  known_.push_back(&kept);
}

}  // namespace sundog::spmd
