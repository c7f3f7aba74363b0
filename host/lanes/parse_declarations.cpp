// Parses declarations outside functions: structures, constants, function heads.
#include <fmt/format.h>

#include <algorithm>

#include "lanes/parser.h"

namespace sundog::spmd {
namespace {

Type scalar(Type::Kind kind, const char* name) {
  Type t;
  t.kind = kind;
  t.name = name;
  return t;
}

}  // namespace

Parser::Parser(const Source& source, const std::function<bool(const std::string&)>& is_plain)
    : tokens_(source.tokens), is_plain_(is_plain) {
  using Kind = Type::Kind;
  types_ = {{"void", scalar(Kind::nothing, "void")}, {"bool", scalar(Kind::boolean, "bool")},
            {"int", scalar(Kind::integer, "int")},   {"uint", scalar(Kind::natural, "uint")},
            {"u32", scalar(Kind::natural, "u32")},   {"i32", scalar(Kind::integer, "int")},
            {"float", scalar(Kind::real, "float")}};
  for (const char* name : {"char", "uchar", "short", "ushort", "long", "ulong", "size_t", "double", "half"})
    types_[name] = scalar(Kind::other, name);
  const std::pair<const char*, Kind> parts[] = {
      {"float", Kind::real}, {"int", Kind::integer}, {"uint", Kind::natural}};
  for (const auto& [part, kind] : parts)
    for (int n = 2; n <= 4; ++n) {
      const std::string name = fmt::format("{}{}", part, n);
      const std::string lanes = kind == Kind::real ? fmt::format("REAL{}", n) : "";
      const VectorForm& form = out_.forms.emplace_back(VectorForm{name, lanes, "", n});
      Type t = scalar(Kind::vector, "");
      t.name = name;
      t.form = &form;
      t.part = kind;
      types_[name] = t;
    }
  for (const char* name :
       {"INFINITY", "MAXFLOAT", "FLT_MIN", "FLT_MAX", "FLT_EPSILON", "M_PI_F", "M_1_PI_F", "M_PI_2_F", "NAN"})
    constants_[name] = types_["float"];
}

Program Parser::program() {
  while (word().kind != Token::Kind::end) declaration();
  for (const Function& f : out_.functions)
    if (f.is_entry && !f.body) fail(f.place, fmt::format("ENTRY of '{}', which has no text", f.name));
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
  if (!take(text)) fail(place(), fmt::format("wanted '{}', found '{}'", text, word().text));
}
std::string Parser::name(std::string_view what) {
  if (word().kind != Token::Kind::name)
    fail(place(), fmt::format("wanted the name of {}, found '{}'", what, word().text));
  return tokens_[at_++].text;
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
  if (is_plain_(*place().file)) return plain_declaration();
  // A header that devices and host share: what is not understood there is not known here.
  const std::size_t from = at_;
  try {
    plain_declaration();
  } catch (const std::exception&) {
    at_ = from;
    skip_declaration();
  }
}

void Parser::skip_declaration() {
  while (word().kind != Token::Kind::end && !take(";")) {
    const bool ends = at("{");
    if (at("(") || at("{") || at("["))
      skip_brackets();
    else
      ++at_;
    if (ends && !at(";") && word().kind != Token::Kind::name) return;
    if (ends && word().kind == Token::Kind::name && !word(1).is(";")) return;
  }
}

void Parser::plain_declaration() {
  if (at("typedef")) return type_definition();
  if (at("LANE_VECTOR")) return vector_definition();
  if (at("HAVING") && word(4).is(";")) {
    features_[place().file] = word(2).text;
    at_ += 5;
    return;
  }
  if (at("enum")) {
    enumeration();
    return want(";");
  }
  if (take("CONSTANT")) {
    const Type type = base_type();
    constants_[name("a constant")] = type;
    return want(";");
  }
  if (at("struct") && word(2).is("{")) {
    Structure s;
    const std::string named = word(1).text;
    structure(s);
    made_structure(named, std::move(s));
    return want(";");
  }
  function();
}

void Parser::type_definition() {
  want("typedef");
  if (at("enum")) {
    enumeration();
    if (word().kind == Token::Kind::name) types_[name("a type")] = types_["uint"];
    return want(";");
  }
  if (at("struct") && (word(1).is("{") || word(2).is("{") || word(1).is("LANES") || word(2).is("LANES"))) {
    Structure s;
    structure(s);
    made_structure(name("a type"), std::move(s));
    return want(";");
  }
  const Type type = pointed(base_type());
  const std::string named = name("a type");
  types_.try_emplace(named, type);
  want(";");
}

void Parser::vector_definition() {
  want("LANE_VECTOR");
  want("(");
  VectorForm form;
  form.name = name("a vector");
  want(",");
  form.lanes = name("its lane form");
  want(",");
  form.prefix = name("its functions");
  want(",");
  form.parts = std::stoi(number()->digits);
  want(")");
  want(";");
  Type t;
  t.kind = Type::Kind::vector;
  t.name = form.name;
  t.form = &out_.forms.emplace_back(form);
  types_[form.name] = t;
}

void Parser::enumeration() {
  want("enum");
  if (word().kind == Token::Kind::name) ++at_;
  if (take(":")) base_type();
  if (!at("{")) return;
  want("{");
  while (!take("}")) {
    constants_[name("a constant")] = types_["int"];
    while (!at(",") && !at("}")) ++at_;
    take(",");
  }
}

const Structure* Parser::made_structure(std::string named, Structure&& s) {
  s.name = named;
  s.shared = !is_plain_(*s.place.file);
  if (s.lanes.empty()) s.lanes = named + "s";
  if (types_.contains(named)) fail(s.place, fmt::format("there is a type '{}' already", named));
  const Structure* kept = &out_.structures.emplace_back(std::move(s));
  Type t;
  t.kind = Type::Kind::structure;
  t.name = named;
  t.structure = kept;
  types_[named] = t;
  return kept;
}

/// `struct [name] [LANES(name, join)] { members }`
void Parser::structure(Structure& s) {
  s.place = place();
  want("struct");
  if (word().kind == Token::Kind::name && !at("LANES")) ++at_;
  if (take("LANES")) {
    want("(");
    s.by_hand = true;
    s.lanes = name("a lane form");
    if (take(",")) s.join = name("what joins lanes");
    want(")");
  }
  members(s);
}

void Parser::members(Structure& s) {
  want("{");
  while (!take("}")) {
    Member common;
    if (take("HAVING")) {
      want("(");
      common.feature = name("a feature");
      want(")");
    }
    common.uniform = take("UNIFORM");
    const Type base = base_type();
    do {
      Member member = common;
      member.type = pointed(base);
      member.name = name("a member");
      member.type = lengthened(member.type);
      s.members.push_back(std::move(member));
    } while (take(","));
    want(";");
  }
}

bool Parser::begins_type(std::size_t ahead) const {
  const Token& t = word(ahead);
  static const std::set<std::string, std::less<>> qualifiers{
      "const",    "struct", "__global", "__constant", "__private",
      "unsigned", "global", "constant", "restrict",   "volatile"};
  return t.kind == Token::Kind::name && (qualifiers.contains(t.text) || types_.contains(t.text));
}

Type Parser::base_type() {
  Space space = Space::own;
  bool constant = false, is_unsigned = false, found = false;
  Type type;
  for (;; ++at_) {
    if (at("const"))
      constant = true;
    else if (at("__global") || at("global"))
      space = Space::global;
    else if (at("__constant") || at("constant"))
      space = Space::constant;
    else if (at("__local") || at("local"))
      space = Space::local;
    else if (at("unsigned"))
      is_unsigned = true;
    else if (at("struct") || at("__private") || at("restrict") || at("volatile"))
      continue;
    else if (const auto known = types_.find(word().text); !found && known != types_.end()) {
      type = known->second;
      found = true;
    } else
      break;
  }
  if (is_unsigned && !found) {
    type = types_["uint"];
    found = true;
  }
  if (!found) fail(place(), fmt::format("'{}' is no type", word().text));
  if (is_unsigned && type.is(Type::Kind::integer)) type = types_["uint"];
  type.space = space;
  type.constant = constant;
  return type;
}

Type Parser::pointed(Type type) {
  while (take("*")) {
    if (type.is(Type::Kind::pointer)) fail(place(), "a pointer to a pointer");
    Type pointer;
    pointer.kind = Type::Kind::pointer;
    pointer.space = type.space;
    pointer.constant = type.constant;
    pointer.of = std::make_shared<const Type>(type);
    type = pointer;
    while (take("const") || take("restrict")) {
    }
  }
  return type;
}

Type Parser::lengthened(Type type) {
  if (!take("[")) return type;
  const Place where = place();
  ExpressionPtr length = condition();
  want("]");
  if (length->kind != Expression::Kind::number) fail(where, "the length of an array is a number");
  Type array;
  array.kind = Type::Kind::array;
  array.length = std::stoi(length->digits, nullptr, 0);
  array.of = std::make_shared<const Type>(lengthened(std::move(type)));
  return array;
}

void Parser::function() {
  Function f;
  f.feature = features_[place().file];
  for (;; ++at_) {
    if (at("inline"))
      f.is_inline = true;
    else if (at("ENTRY"))
      f.is_entry = true;
    else if (at("UNIFORM"))
      f.uniform = true;
    else if (at("HAVING")) {
      at_ += 2;
      if (!f.feature.empty()) f.feature += " && ";
      f.feature += name("a feature");
    } else if (at("CALLED")) {
      at_ += 2;
      f.lanes = name("a function");
    } else if (!at("static") && !at("NEVER_INLINE"))
      break;
  }
  f.result = pointed(base_type());
  f.result.constant = false;
  f.place = place();
  f.name = name("a function");
  if (f.lanes.empty()) f.lanes = f.name;
  scopes_.emplace_back();
  parameters(f);
  const bool plain = is_plain_(*f.place.file);
  f.uniform |= !plain;
  Function& kept = out_.functions.emplace_back(std::move(f));
  const Function*& known = out_.function_of[kept.name];  // a prototype may stand before the text
  if (known && (known->body || !at("{"))) fail(kept.place, fmt::format("'{}' is there already", kept.name));
  known = &kept;
  if (!at("{")) {
    want(";");
  } else if (!plain) {
    skip_brackets();
  } else {
    function_ = &kept;
    kept.body = block();
    function_ = nullptr;
  }
  scopes_.pop_back();
}

void Parser::parameters(Function& f) {
  want("(");
  if (at("void") && word(1).is(")")) ++at_;
  while (!take(")")) {
    Variable v;
    v.place = place();
    if (take("HERE")) {
      v.here = true;
      f.takes_mask = true;
    } else {
      v.uniform = take("UNIFORM");
      v.type = lengthened(pointed(base_type()));
      v.name = name("a parameter");
      v.type = lengthened(v.type);
      if (v.type.is(Type::Kind::array)) {  // is handed over as a pointer
        Type pointer;
        pointer.kind = Type::Kind::pointer;
        pointer.of = v.type.of;
        v.type = pointer;
      }
    }
    const Variable& kept = out_.variables.emplace_back(std::move(v));
    if (!kept.here) scopes_.back()[kept.name] = &kept;
    f.parameters.push_back(&kept);
    if (!at(")")) want(",");
  }
}

Program parse(const Source& source, const std::function<bool(const std::string&)>& is_plain) {
  return Parser(source, is_plain).program();
}

}  // namespace sundog::spmd
