// Expressions: of one value for all lanes as they were written, of others in lanes.
#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

constexpr std::string_view letters = "xyzw";

bool is_name(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; });
}

/// The text of a whole number as one of `type`; empty: it has to be cast.
std::string number_of(const Expression& e, const Type& type) {
  const std::string& text = e.text;
  if (e.kind != Kind::number || e.type.is_real() || text != e.digits) return "";
  if (type.is_natural()) return text + "u";
  if (!type.is_real() || text.starts_with("0x")) return "";
  return (text.ends_with('u') ? text.substr(0, text.size() - 1) : text) + ".0f";
}

}  // namespace

std::string Writer::type_text(const Type& type, bool varying) {
  if (type.is_nothing()) return "void";
  if (type.is_pointer()) {
    return fmt::format("{}{}{}*", type.global ? "__global " : "", type.constant ? "const " : "",
                       type_text(*type.of, varying && !type.global));
  }
  if (type.is_structure()) {
    const Structure& s = *type.structure;
    const bool in_lanes = varying || s.by_hand;
    if (in_lanes && s.shared) fail(place_, "a {} of each lane: only its members may vary", type.name);
    if (!s.by_hand && !s.shared) structures_.emplace(&s, in_lanes);
    return in_lanes ? s.lanes : type.name;
  }
  if (!varying) return type.name;
  const std::string text = type.is_vector()    ? type.form->lanes
                           : type.is_real()    ? "REAL"
                           : type.is_natural() ? "UINTS"
                           : type.is_number()  ? "MASK"
                                               : "";
  if (text.empty()) fail(place_, "a {} has no lanes", type.name);
  return text;
}

bool Writer::varies(const Expression& e) {
  const double cost = s_.cost;
  const bool v = s_.varies(e, frames_);
  s_.cost = cost;
  return v;
}

std::string Writer::value(const Expression& e) { return varies(e) ? varying(e) : plain(e); }

std::string Writer::lanes(const Expression& e) {
  return varies(e) || e.kind == Kind::list ? varying(e) : spread(plain(e), e.type);
}

std::string Writer::spread(const std::string& text, const Type& type) {
  if (type.is_vector()) return fmt::format("{}({})", type.form->function("all"), text);
  if (type.is_truth()) {
    if (text == "true") return "ALL_LANES";
    return text == "false" ? "NO_LANES" : fmt::format("LANES_IF({})", text);
  }
  if (type.is_structure()) {
    type_text(type, true);
    type_text(type, false);
    return fmt::format("all_{}({})", type.name, text);
  }
  if (type.is_pointer() || type.is_array()) return text;
  if (type.is(Type::Kind::integer))  // a number without a sign in an expression of whole numbers
    return fmt::format("(MASK)((int)({}))", text);
  return fmt::format("({})({})", type_text(type, true), text);
}

std::string Writer::plain(const Expression& e) {
  const auto part = [&](std::size_t i) { return plain(*e.of[i]); };
  const auto parts = [&] { return joined(e.of, [&](const ExpressionPtr& one) { return plain(*one); }); };
  switch (e.kind) {
    case Kind::number:
    case Kind::constant:
    case Kind::variable:
      return e.text;
    case Kind::member:
    case Kind::component:
      return part(0) + (e.arrow ? "->" : ".") + e.text;
    case Kind::index:
      return fmt::format("{}[{}]", part(0), part(1));
    case Kind::unary:
      if (e.postfix) return part(0) + e.text;
      return e.text == "&" || e.text == "!" || e.steps() ? e.text + part(0)
                                                         : fmt::format("({}{})", e.text, part(0));
    case Kind::binary:
      return fmt::format("({} {} {})", part(0), e.text, part(1));
    case Kind::assign:
      return fmt::format("{} = {}", part(0), part(1));
    case Kind::choose:
      return fmt::format("({} ? {} : {})", part(0), part(1), part(2));
    case Kind::cast:
      if (const std::string number = number_of(*e.of[0], e.type); e.implicit && !number.empty())
        return number;
      if (e.implicit && e.type.is_truth()) return part(0);
      [[fallthrough]];
    case Kind::vector:
      return fmt::format("({})({})", type_text(e.type, false), parts());
    case Kind::list:
      return "{" + parts() + "}";
    case Kind::call:
      return call(e);
    case Kind::any:
      if (!varies(*e.of[0])) return part(0);
      return fmt::format("(any_lane({} & {}) != 0)", mask_, mask_of(*e.of[0]));
  }
  return "";
}

std::string Writer::place_of(const Expression& e) {
  return varies(e) || e.type.is_own_pointer() ? varying(e) : plain(e);
}

std::string Writer::simple(const Expression& e) {
  const std::string text = lanes(e);
  if (is_name(text)) return text;
  const std::string name = fresh("part");
  line("const {} {} = {};", type_text(e.type, true), name, text);
  return name;
}

std::string Writer::varying(const Expression& e) {
  const auto vector_of = [](const std::string& all, auto parts) {
    return fmt::format("real{}({})", parts, all);
  };
  if (is_gathered(e) && e.kind != Kind::component)
    return e.type.is_vector() ? vector_of(parts_of(e), e.type.form->parts) : gather(e);
  switch (e.kind) {
    case Kind::variable:
      return e.text;
    case Kind::cast:
      return e.type.is_truth() ? mask_of(e) : varying_cast(e);
    case Kind::vector: {
      if (e.type.part != Type::Kind::real) fail(e.place, "a {} has no lanes", e.type.name);
      const std::string all = joined(e.of, [&](const ExpressionPtr& part) {
        return part->type.is_vector() ? parts_of(*part) : lanes(*part);
      });
      return vector_of(all, e.type.form->parts);
    }
    case Kind::component:
      if (e.text.size() > 1) return vector_of(parts_of(*e.of[0], e.text), e.text.size());
      if (is_gathered(e)) return gather(e);
      [[fallthrough]];
    case Kind::member:
      return place_of(*e.of[0]) + (e.arrow ? "->" : ".") + e.text;
    case Kind::index:
      return element(e);
    case Kind::unary:
      return varying_unary(e);
    case Kind::binary:
      return e.type.is_truth()    ? mask_of(e)
             : e.type.is_vector() ? varying_vector_binary(e)
                                  : varying_binary(e);
    case Kind::choose:
      return varying_choice(e);
    case Kind::call:
      return call(e);
    case Kind::list: {
      std::size_t i = 0;
      return "{" +
             joined(e.of,
                    [&](const ExpressionPtr& part) {
                      const bool uniform = e.type.is_structure() && e.type.structure->members[i++].uniform;
                      return uniform ? plain(*part) : lanes(*part);
                    }) +
             "}";
    }
    default:
      fail(e.place, "this has no value within an expression");
  }
}

std::string Writer::varying_cast(const Expression& e) {
  const Expression& of = *e.of[0];
  const Type &to = e.type, &from = of.type;
  if (to.is_vector()) {
    if (!varies(of)) return fmt::format("{}({})", to.form->function("all"), plain(of));
    if (!to.form->prefix.empty()) fail(e.place, "a {} of one number that varies", to.name);
    const std::vector<std::string> all(static_cast<std::size_t>(to.form->parts), simple(of));
    return fmt::format("real{}({})", to.form->parts, fmt::join(all, ", "));
  }
  const std::string text = from.is_truth() ? fmt::format("({} & 1)", mask_of(of)) : lanes(of);
  if (to.is_real()) return fmt::format("TO_REAL({})", text);
  if (to.is_natural()) return fmt::format("{}({})", from.is_real() ? "REAL_TO_UINTS" : "AS_UINTS", text);
  if (from.is_truth()) return text;
  return fmt::format("{}({})", from.is_real() ? "TO_MASK" : "AS_MASK", text);
}

/// The parts of a vector: those wanted, or all.
std::string Writer::parts_of(const Expression& e, std::string_view wanted) {
  if (wanted.empty()) wanted = letters.substr(0, static_cast<std::size_t>(e.type.form->parts));
  const bool gathers = is_gathered(e);
  const std::string base = gathers ? "" : simple(e);
  return joined(wanted, [&](char c) { return gathers ? gather(e, letters.find(c)) : base + "." + c; });
}

std::string Writer::varying_unary(const Expression& e) {
  const Expression& of = *e.of[0];
  if (e.text == "!") return mask_of(e);
  if (e.text == "-" && e.type.is_vector())
    return fmt::format("{}({})", e.type.form->function("negate"), lanes(of));
  if (e.text == "*") return fmt::format("(*{})", varying(of));
  if (e.text == "&") return "&" + place_of(of);
  return fmt::format("({}{})", e.text, lanes(of));
}

std::string Writer::varying_vector_binary(const Expression& e) {
  static const std::map<std::string, std::string> names{
      {"+", "add"}, {"-", "subtract"}, {"*", "multiply"}, {"/", "divide"}};
  std::string name = names.at(e.text);
  const Expression *a = e.of[0].get(), *b = e.of[1].get();
  const auto is_spread = [](const Expression* x) {
    return x->kind == Kind::cast && x->type.is_vector() && !x->of[0]->type.is_vector();
  };
  if (e.text == "*" && (is_spread(a) || is_spread(b))) {
    if (!is_spread(b)) std::swap(a, b);
    b = b->of[0].get();
    name = "scale";
  }
  const std::string first = lanes(*a);
  return fmt::format("{}({}, {})", e.type.form->function(name), first, lanes(*b));
}

std::string Writer::varying_binary(const Expression& e) {
  const Expression &a = *e.of[0], &b = *e.of[1];
  if (e.divides_whole() && varies(b)) {  // lanes that are off must not trap, so they divide by 1
    const std::string by = lanes(b), one = fmt::format("({})(1)", type_text(e.type, true));
    return fmt::format("({} {} select({}, {}, {}))", lanes(a), e.text, one, by, mask_);
  }
  const bool shifts = e.text == "<<" || e.text == ">>";
  const std::string first = shifts ? lanes(a) : value(a);
  return fmt::format("({} {} {})", first, e.text, shifts ? lanes(b) : value(b));
}

}  // namespace sundog::spmd
