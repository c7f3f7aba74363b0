// Expressions: of one value for all lanes as they were written, of others in lanes.
#include <fmt/format.h>

#include <algorithm>

#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

/// Where a vector is made of one number.
const Expression* spread_number(const Expression& e) {
  const bool is =
      e.kind == Kind::cast && e.type.is(Type::Kind::vector) && !e.of[0]->type.is(Type::Kind::vector);
  return is ? e.of[0].get() : nullptr;
}

bool is_name(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; });
}

std::string number_of(const std::string& text, const Type& type) {
  if (type.is(Type::Kind::natural) && is_name(text) && !text.ends_with('u') &&
      std::isdigit(static_cast<unsigned char>(text[0])))
    return text + "u";
  if (type.is(Type::Kind::real) && std::isdigit(static_cast<unsigned char>(text[0])) &&
      !text.starts_with("0x"))
    return (text.ends_with('u') ? text.substr(0, text.size() - 1) : text) + ".0f";
  return "";
}

}  // namespace

std::string Writer::type_text(const Type& type, bool varying) {
  using T = Type::Kind;
  if (type.is(T::nothing)) return "void";
  if (type.is(T::pointer)) {
    const char* space = type.space == Space::global     ? "__global "
                        : type.space == Space::constant ? "__constant "
                        : type.space == Space::local    ? "__local "
                                                        : "";
    return fmt::format("{}{}{}*", space, type.constant ? "const " : "",
                       type_text(*type.of, varying && type.space == Space::own));
  }
  if (type.is(T::structure) && (type.structure->by_hand || varying)) {
    if (type.structure->shared)
      fail(place_, fmt::format("a {} of each lane: only its members may vary", type.name));
    if (!type.structure->by_hand) structures_.emplace(type.structure, true);
    return type.structure->lanes;
  }
  if (type.is(T::structure) && !type.structure->shared) structures_.emplace(type.structure, false);
  if (type.is(T::vector) && varying) {
    if (type.form->lanes.empty()) fail(place_, fmt::format("a {} has no lanes", type.name));
    return type.form->lanes;
  }
  if (!varying) return type.name;
  if (type.is(T::real)) return "REAL";
  if (type.is(T::integer) || type.is(T::boolean)) return "MASK";
  if (type.is(T::natural)) return "UINTS";
  fail(place_, fmt::format("a {} has no lanes", type.name));
}

bool Writer::varies(const Expression& e) {
  const double cost = s_.cost;
  const bool v = s_.varies(e, frames_);
  s_.cost = cost;
  return v;
}

std::string Writer::value(const Expression& e) { return varies(e) ? varying(e) : plain(e); }

std::string Writer::lanes(const Expression& e) {
  return varies(e) || e.kind == Kind::list ? varying(e) : spread(plain(e), e);
}

std::string Writer::spread(const std::string& text, const Expression& e) {
  switch (e.type.kind) {
    case Type::Kind::vector:
      return fmt::format("{}({})", e.type.form->function("all"), text);
    case Type::Kind::boolean:
      if (text == "true") return "ALL_LANES";
      if (text == "false") return "NO_LANES";
      return fmt::format("LANES_IF({})", text);
    case Type::Kind::structure:
      type_text(e.type, true);
      type_text(e.type, false);
      return fmt::format("all_{}({})", e.type.name, text);
    case Type::Kind::pointer:
    case Type::Kind::array:
      return text;
    case Type::Kind::integer:  // a number without a sign in an expression of whole numbers
      return fmt::format("(MASK)((int)({}))", text);
    default:
      return fmt::format("({})({})", type_text(e.type, true), text);
  }
}

std::string Writer::plain(const Expression& e) {
  const auto part = [&](std::size_t i) { return plain(*e.of[i]); };
  const auto parts = [&] {
    std::string all;
    for (std::size_t i = 0; i < e.of.size(); ++i) all += (i ? ", " : "") + part(i);
    return all;
  };
  switch (e.kind) {
    case Kind::number:
    case Kind::constant:
    case Kind::variable:
      return e.text;
    case Kind::member:
      return part(0) + (e.arrow ? "->" : ".") + e.text;
    case Kind::component:
      return part(0) + "." + e.text;
    case Kind::index:
      return fmt::format("{}[{}]", part(0), part(1));
    case Kind::unary:
      if (e.postfix) return part(0) + e.text;
      return e.text == "&" || e.text == "!" || e.text.size() == 2 ? e.text + part(0)
                                                                  : fmt::format("({}{})", e.text, part(0));
    case Kind::binary:
      return fmt::format("({} {} {})", part(0), e.text, part(1));
    case Kind::assign:
      return fmt::format("{} = {}", part(0), part(1));
    case Kind::choose:
      return fmt::format("({} ? {} : {})", part(0), part(1), part(2));
    case Kind::cast: {
      if (e.implicit && e.of[0]->kind == Kind::number)
        if (const std::string number = number_of(part(0), e.type); !number.empty()) return number;
      if (e.implicit && e.type.is(Type::Kind::boolean)) return part(0);
      return fmt::format("({})({})", type_text(e.type, false), part(0));
    }
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
  std::string text = lanes(e);
  if (is_name(text)) return text;
  const std::string name = fresh("part");
  line(fmt::format("const {} {} = {};", type_text(e.type, true), name, text));
  return name;
}

/// Calls `write` with the mask narrowed to `mask`; returns its text.
std::string Writer::under(const std::string& mask, const Write& write) {
  const std::string outer = mask_;
  mask_ = fresh("m");
  const std::size_t at = out_.size();
  line(fmt::format("const MASK {} = {} & {};", mask_, outer, mask));
  std::string text = write();
  if (!mentions(text, mask_)) drop_unused(at, mask_);
  mask_ = outer;
  return text;
}

/// Whether computing e sets variables.
bool Writer::writes(const Expression& e) const {
  if (e.kind == Kind::call && e.function)
    for (const Variable* p : e.function->parameters)
      if (p->type.is_own_pointer() && !p->type.constant) return true;
  return std::ranges::any_of(e.of, [&](const ExpressionPtr& part) { return writes(*part); });
}

/// Whether e must not be computed in lanes that do not ask for it.
bool Writer::is_guarded(const Expression& e) {
  if (e.kind == Kind::index && varies(*e.of[1])) return true;
  if (e.kind == Kind::member && is_gathered(e)) return true;
  if (e.kind == Kind::any) return true;
  if (e.kind == Kind::binary && (e.text == "/" || e.text == "%") && e.type.is_whole() && varies(*e.of[1]))
    return true;
  if (e.kind == Kind::call && e.function) {
    if (!e.function->body && e.function->takes_mask) return true;
    if (e.function->body && all_.of(*e.function, s_.arguments_of(e, frames_)).masked) return true;
  }
  return std::ranges::any_of(e.of, [&](const ExpressionPtr& part) { return is_guarded(*part); });
}

std::string Writer::varying(const Expression& e) {
  const bool is_condition = e.type.is(Type::Kind::boolean) && e.kind != Kind::variable &&
                            e.kind != Kind::member && e.kind != Kind::call && e.kind != Kind::index &&
                            e.kind != Kind::assign;
  if (is_condition && !(e.kind == Kind::unary && e.text == "*")) return mask_of(e);
  switch (e.kind) {
    case Kind::variable:
      return e.text;
    case Kind::cast:
      return varying_cast(e);
    case Kind::vector:
      return parts_of(e);
    case Kind::member:
      if (is_gathered(e)) return gather(e);
      return place_of(*e.of[0]) + (e.arrow ? "->" : ".") + e.text;
    case Kind::component: {
      if (is_gathered(*e.of[0])) {
        if (e.text.size() == 1) return gather(e);
        std::string all;
        for (const char c : e.text)
          all += (all.empty() ? "" : ", ") +
                 gather(*e.of[0], static_cast<int>(std::string("xyzw").find(c)), false);
        return fmt::format("real{}({})", e.text.size(), all);
      }
      if (e.text.size() == 1) return place_of(*e.of[0]) + "." + e.text;
      const std::string base = simple(*e.of[0]);
      std::string all;
      for (const char c : e.text) all += (all.empty() ? "" : ", ") + base + "." + c;
      return fmt::format("real{}({})", e.text.size(), all);
    }
    case Kind::index:
      if (is_gathered(e)) return gather(e);
      if (!varies(*e.of[1])) return fmt::format("{}[{}]", place_of(*e.of[0]), plain(*e.of[1]));
      return varying_element(e);
    case Kind::unary:
      return varying_unary(e);
    case Kind::binary:
      return e.type.is(Type::Kind::vector) ? varying_vector_binary(e) : varying_binary(e);
    case Kind::choose:
      return varying_choice(e);
    case Kind::call:
      return call(e);
    case Kind::list: {
      std::string all;
      for (std::size_t i = 0; i < e.of.size(); ++i) {
        const bool uniform = e.type.is(Type::Kind::structure) && e.type.structure->members[i].uniform;
        all += (i ? ", " : "") + (uniform ? plain(*e.of[i]) : lanes(*e.of[i]));
      }
      return "{" + all + "}";
    }
    default:
      fail(e.place, "this has no value within an expression");
  }
}

std::string Writer::varying_cast(const Expression& e) {
  using T = Type::Kind;
  const Expression& of = *e.of[0];
  const Type &to = e.type, &from = of.type;
  if (to.is(T::vector)) {
    if (!varies(of)) return fmt::format("{}({})", to.form->function("all"), plain(of));
    if (!to.form->prefix.empty()) fail(e.place, fmt::format("a {} of one number that varies", to.name));
    const std::string part = simple(of);
    std::string all = part;
    for (int i = 1; i < to.form->parts; ++i) all += ", " + part;
    return fmt::format("real{}({})", to.form->parts, all);
  }
  const std::string text = from.is(T::boolean) ? fmt::format("({} & 1)", mask_of(of)) : lanes(of);
  const bool was_natural = from.is(T::natural);
  if (to.is(T::real)) return fmt::format("TO_REAL({})", text);
  if (to.is(T::integer))
    return from.is(T::real) ? fmt::format("TO_MASK({})", text)
           : was_natural    ? fmt::format("AS_MASK({})", text)
                            : text;
  if (to.is(T::natural))
    return from.is(T::real) ? fmt::format("REAL_TO_UINTS({})", text) : fmt::format("AS_UINTS({})", text);
  fail(e.place, fmt::format("a {} has no lanes", to.name));
}

std::string Writer::parts_of(const Expression& e) {
  if (e.type.part != Type::Kind::real) fail(e.place, fmt::format("a {} has no lanes", e.type.name));
  std::string all;
  for (const ExpressionPtr& part : e.of) {
    if (!part->type.is(Type::Kind::vector)) {
      all += (all.empty() ? "" : ", ") + lanes(*part);
      continue;
    }
    const std::string base = simple(*part);
    for (int i = 0; i < part->type.form->parts; ++i)
      all += (all.empty() ? "" : ", ") + base + "." + "xyzw"[i];
  }
  return fmt::format("real{}({})", e.type.form->parts, all);
}

/// An element of an array of lanes, or of one, at a place that differs from lane to lane.
std::string Writer::varying_element(const Expression& e) {
  if (!e.type.is(Type::Kind::real) && !e.type.is(Type::Kind::integer))
    fail(e.place, fmt::format("an element that varies of an array of {}", name_of(e.type)));
  const std::string name = fresh("element"), lane = fresh("lane"), index = simple(*e.of[1]);
  const char* part = e.type.is(Type::Kind::real) ? "REAL_LANE" : "MASK_LANE";
  const std::string place = fmt::format("{}[MASK_LANE({}, {})]", place_of(*e.of[0]), index, lane);
  line(fmt::format("{0} {1} = ({0})(0);", type_text(e.type, true), name));
  const std::string found = varies(*e.of[0]) ? fmt::format("{}({}, {})", part, place, lane) : place;
  line(fmt::format("EACH_LANE({0}, {1}) {2}({3}, {0}) = {4};", lane, mask_, part, name, found));
  return name;
}

std::string Writer::varying_unary(const Expression& e) {
  const Expression& of = *e.of[0];
  if (e.text == "-" && e.type.is(Type::Kind::vector))
    return fmt::format("{}({})", e.type.form->function("negate"), lanes(of));
  if (e.text == "-" || e.text == "~") return fmt::format("({}{})", e.text, lanes(of));
  if (e.text == "+") return lanes(of);
  if (e.text == "*") return fmt::format("(*{})", varying(of));
  if (e.text == "&") return "&" + place_of(of);
  fail(e.place, fmt::format("'{}' within an expression", e.text));
}

std::string Writer::varying_vector_binary(const Expression& e) {
  const Expression &a = *e.of[0], &b = *e.of[1];
  static const std::map<std::string, std::string> names{
      {"+", "add"}, {"-", "subtract"}, {"*", "multiply"}, {"/", "divide"}};
  const Expression *number_a = spread_number(a), *number_b = spread_number(b);
  const VectorForm& form = *e.type.form;
  if (e.text == "*" && number_b) {
    const std::string first = lanes(a);
    return fmt::format("{}({}, {})", form.function("scale"), first, lanes(*number_b));
  }
  if (e.text == "*" && number_a) {
    const std::string first = lanes(b);
    return fmt::format("{}({}, {})", form.function("scale"), first, lanes(*number_a));
  }
  const std::string first = lanes(a);
  return fmt::format("{}({}, {})", form.function(names.at(e.text)), first, lanes(b));
}

std::string Writer::varying_binary(const Expression& e) {
  const Expression &a = *e.of[0], &b = *e.of[1];
  // Lanes that are off must not trap, so they divide by 1.
  if ((e.text == "/" || e.text == "%") && e.type.is_whole() && varies(b)) {
    const std::string by = lanes(b), one = fmt::format("({})(1)", type_text(e.type, true));
    const std::string mask = s_.masked ? mask_ : "ALL_LANES";
    return fmt::format("({} {} select({}, {}, {}))", lanes(a), e.text, one, by, mask);
  }
  const bool shifts = e.text == "<<" || e.text == ">>";
  const std::string first = shifts ? lanes(a) : value(a);
  return fmt::format("({} {} {})", first, e.text, shifts ? lanes(b) : value(b));
}

}  // namespace sundog::spmd
