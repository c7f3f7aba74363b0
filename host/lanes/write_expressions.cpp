// Writes expressions: as in the source if they have one value for all lanes, otherwise in lanes.
#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

constexpr std::string_view letters = "xyzw";

bool is_name(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; });
}

/// The text of a whole number as a literal of `type`; empty if it needs a cast.
std::string number_of(const Expression& e, const Type& type) {
  const std::string& text = e.text;
  if (e.kind != Kind::number || e.type.is_real() || text != e.digits) return "";
  if (type.is_natural()) return text + "u";
  if (!type.is_real() || text.starts_with("0x")) return "";
  return (text.ends_with('u') ? text.substr(0, text.size() - 1) : text) + ".0f";
}

/// Whether computing e sets variables.
bool writes(const Expression& e) {
  return any_within(e, [](const Expression& part) {
    return part.function && std::ranges::any_of(part.function->parameters, [](const Variable* p) {
             return p->type.is_own_pointer() && !p->type.constant;
           });
  });
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

std::string Writer::lanes(const Expression& e) {
  if (e.kind != Kind::list) return varies(e) ? value(e) : spread(value(e), e.type);
  return "{" + joined(e.of, [&](const ExpressionPtr& part) { return lanes(*part); }) + "}";
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
  if (type.is(Type::Kind::integer))  // the text may be unsigned
    return fmt::format("(MASK)((int)({}))", text);
  return fmt::format("({})({})", type_text(type, true), text);
}

std::string Writer::simple(const Expression& e) {
  const std::string text = lanes(e);
  if (is_name(text)) return text;
  const std::string name = fresh("part");
  line("const {} {} = {};", type_text(e.type, true), name, text);
  return name;
}

/// The expression as in the source, in lanes if it varies.
std::string Writer::value(const Expression& e) {
  const bool v = varies(e);
  const auto part = [&](std::size_t i) { return value(*e.of[i]); };
  const auto all_values = [&] { return joined(e.of, [&](const ExpressionPtr& one) { return value(*one); }); };
  const auto vector_of = [](const std::string& all, auto parts) {
    return fmt::format("real{}({})", parts, all);
  };
  if (is_gathered(e) && e.kind != Kind::component)
    return e.type.is_vector() ? vector_of(parts_of(e), e.type.form->parts) : gather(e);
  switch (e.kind) {
    case Kind::number:
    case Kind::constant:
    case Kind::variable:
      return e.text;
    case Kind::component:
      if (v && e.text.size() > 1) return vector_of(parts_of(*e.of[0], e.text), e.text.size());
      if (is_gathered(e)) return gather(e);
      [[fallthrough]];
    case Kind::member:
      return part(0) + (e.arrow ? "->" : ".") + e.text;
    case Kind::index:
      return varies(*e.of[1]) ? element(e) : fmt::format("{}[{}]", part(0), part(1));
    case Kind::unary:
      if (v && e.text == "!") return mask_of(e);
      if (v && e.text == "-" && e.type.is_vector())
        return fmt::format("{}({})", e.type.form->function("negate"), part(0));
      if (e.postfix) return part(0) + e.text;
      return e.text == "&" || e.text == "!" || e.steps() ? e.text + part(0)
                                                         : fmt::format("({}{})", e.text, part(0));
    case Kind::binary:
      if (v && e.type.is_truth()) return mask_of(e);
      if (v) return e.type.is_vector() ? varying_vector_binary(e) : varying_binary(e);
      return fmt::format("({} {} {})", part(0), e.text, part(1));
    case Kind::assign:
      return fmt::format("{} = {}", part(0), part(1));
    case Kind::choose:
      return v ? varying_choice(e) : fmt::format("({} ? {} : {})", part(0), part(1), part(2));
    case Kind::cast:
      if (v) return e.type.is_truth() ? mask_of(e) : varying_cast(e);
      if (const std::string number = number_of(*e.of[0], e.type); e.implicit && !number.empty())
        return number;
      if (e.implicit && e.type.is_truth()) return part(0);
      return fmt::format("({})({})", type_text(e.type, false), part(0));
    case Kind::vector: {
      if (!v) return fmt::format("({})({})", type_text(e.type, false), all_values());
      const std::string all = joined(e.of, [&](const ExpressionPtr& one) {
        return one->type.is_vector() ? parts_of(*one) : lanes(*one);
      });
      return vector_of(all, e.type.form->parts);
    }
    case Kind::list:
      return "{" + all_values() + "}";
    case Kind::call:
      return call(e);
    case Kind::any:
      break;
  }
  return varies(*e.of[0]) ? fmt::format("(any_lane({} & {}) != 0)", mask_, mask_of(*e.of[0])) : part(0);
}

std::string Writer::varying_cast(const Expression& e) {
  const Expression& of = *e.of[0];
  const Type &to = e.type, &from = of.type;
  if (to.is_vector()) {
    if (!varies(of)) return fmt::format("{}({})", to.form->function("all"), value(of));
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

/// The wanted parts of a vector, or all of them, separated by commas.
std::string Writer::parts_of(const Expression& e, std::string_view wanted) {
  if (wanted.empty()) wanted = letters.substr(0, static_cast<std::size_t>(e.type.form->parts));
  const bool gathers = is_gathered(e);
  const std::string base = gathers ? "" : simple(e);
  return joined(wanted, [&](char c) { return gathers ? gather(e, letters.find(c)) : base + "." + c; });
}

std::string Writer::varying_vector_binary(const Expression& e) {
  static const auto& names = *new const std::map<std::string, std::string>{
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
  if (e.divides_whole() && varies(b)) {  // inactive lanes must not trap, so they divide by 1
    const std::string by = lanes(b), one = fmt::format("({})(1)", type_text(e.type, true));
    return fmt::format("({} {} select({}, {}, {}))", lanes(a), e.text, one, by, mask_);
  }
  const bool shifts = e.text == "<<" || e.text == ">>";
  const std::string first = shifts ? lanes(a) : value(a);
  return fmt::format("({} {} {})", first, e.text, shifts ? lanes(b) : value(b));
}

// ---- conditions as masks, and choices between two values

/// Whether e must not be computed in inactive lanes.
bool Writer::is_guarded(const Expression& e) {
  return any_within(e, [&](const Expression& part) {
    if (part.kind == Kind::any || (part.kind == Kind::member && is_gathered(part))) return true;
    if ((part.kind == Kind::index || part.divides_whole()) && varies(*part.of[1])) return true;
    if (!part.function) return false;
    if (!part.function->body) return part.function->takes_mask;
    return all_.of(*part.function, s_.arguments_of(part, frames_)).masked;
  });
}

/// Calls `write` with the mask narrowed to `mask`; returns its text.
std::string Writer::under(const std::string& mask, const Write& write) {
  const std::string outer = mask_;
  mask_ = fresh("m");
  const std::size_t at = out_.size();
  line("const MASK {} = {} & {};", mask_, outer, mask);
  std::string text = write();
  if (!mentions(text, mask_)) drop_unused(at, mask_);
  mask_ = outer;
  return text;
}

std::string Writer::varying_choice(const Expression& e) {
  const Expression &asked = *e.of[0], &a = *e.of[1], &b = *e.of[2];
  std::string mask;
  if (!varies(asked)) {
    const std::size_t at = out_.size();
    const std::string text = fmt::format("({} ? {} : {})", value(asked), lanes(a), lanes(b));
    if (out_.size() == at) return text;
    out_.resize(at);
    mask = fmt::format("LANES_IF({})", value(asked));
  } else {
    mask = mask_of(asked);
  }
  if (!is_guarded(a) && !is_guarded(b) && !writes(asked)) {
    const std::string second = lanes(b);
    return selected(e.type, second, lanes(a), mask, e.place);
  }
  const std::string is = fresh("is");
  line("const MASK {} = {};", is, mask);
  const std::string otherwise = under("~" + is, [&] { return lanes(b); });
  return selected(e.type, otherwise, under(is, [&] { return lanes(a); }), is, e.place);
}

std::string Writer::selected(const Type& type, const std::string& a, const std::string& b,
                             const std::string& mask, const Place& place) {
  std::string select = "select";
  if (type.is_vector()) select = type.form->function("select");
  if (type.is_structure()) {
    if (type.structure->by_hand)
      fail(place, "a {} is set where lanes part, and nothing joins two", type.name);
    type_text(type, true);
    select += "_" + type.name;
  }
  return fmt::format("{}({}, {}, {})", select, a, b, mask);
}

std::string Writer::mask_of(const Expression& e) {
  if (!varies(e)) return spread(value(e), e.type);
  if (e.kind == Kind::binary && joins(e.text)) return joined_masks(e);
  if (e.kind == Kind::binary) {
    const std::string first = value(*e.of[0]);
    return fmt::format("MASK_OF({} {} {})", first, e.text, value(*e.of[1]));
  }
  if (e.is_unary("!")) return "~" + mask_of(*e.of[0]);
  if (e.kind == Kind::cast) return fmt::format("MASK_OF({} != 0)", lanes(*e.of[0]));
  return e.kind == Kind::choose ? varying_choice(e) : value(e);
}

/// && and ||: evaluates the second condition only where C does.
std::string Writer::joined_masks(const Expression& e) {
  const Expression &a = *e.of[0], &b = *e.of[1];
  const char sign = e.text[0];
  if (!varies(a)) {
    const std::size_t at = out_.size();
    const std::string first = value(a), second = mask_of(b);
    if (out_.size() == at)
      return sign == '&' ? fmt::format("({} ? {} : NO_LANES)", first, second)
                         : fmt::format("({} ? ALL_LANES : {})", first, second);
    out_.resize(at);
  }
  if (!is_guarded(b) && !writes(a)) {
    const std::string first = mask_of(a);
    return fmt::format("({} {} {})", first, sign, mask_of(b));
  }
  const std::string is = fresh("is");
  line("const MASK {} = {};", is, mask_of(a));
  return fmt::format("({} {} {})", is, sign, under(sign == '&' ? is : "~" + is, [&] { return mask_of(b); }));
}

}  // namespace sundog::spmd
