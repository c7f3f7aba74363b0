// Conditions as masks, and choices between two values.
#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

/// Whether computing e sets variables.
bool writes(const Expression& e) {
  return any_within(e, [](const Expression& part) {
    return part.function && std::ranges::any_of(part.function->parameters, [](const Variable* p) {
             return p->type.is_own_pointer() && !p->type.constant;
           });
  });
}

}  // namespace

/// Whether e must not be computed in lanes that do not ask for it.
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
    const std::string text = fmt::format("({} ? {} : {})", plain(asked), lanes(a), lanes(b));
    if (out_.size() == at) return text;
    out_.resize(at);
    mask = fmt::format("LANES_IF({})", plain(asked));
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
  if (!varies(e)) return spread(plain(e), e.type);
  if (e.kind == Kind::binary && joins(e.text)) return joined_masks(e);
  if (e.kind == Kind::binary) {
    const std::string first = value(*e.of[0]);
    return fmt::format("MASK_OF({} {} {})", first, e.text, value(*e.of[1]));
  }
  if (e.is_unary("!")) return "~" + mask_of(*e.of[0]);
  if (e.kind == Kind::cast) return fmt::format("MASK_OF({} != 0)", lanes(*e.of[0]));
  return e.kind == Kind::choose ? varying_choice(e) : varying(e);
}

/// && and ||: the second condition is asked only where C asks it.
std::string Writer::joined_masks(const Expression& e) {
  const Expression &a = *e.of[0], &b = *e.of[1];
  const char sign = e.text[0];
  if (!varies(a)) {
    const std::size_t at = out_.size();
    const std::string first = plain(a), second = mask_of(b);
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
