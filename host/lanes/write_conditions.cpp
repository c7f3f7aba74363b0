// Conditions as masks, and choices between two values.
#include <fmt/format.h>

#include "lanes/writer.h"

namespace sundog::spmd {

using Kind = Expression::Kind;

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
  line(fmt::format("const MASK {} = {};", is, mask));
  const std::string otherwise = under("~" + is, [&] { return lanes(b); });
  return selected(e.type, otherwise, under(is, [&] { return lanes(a); }), is, e.place);
}

std::string Writer::selected(const Type& type, const std::string& a, const std::string& b,
                             const std::string& mask, const Place& place) {
  if (type.is(Type::Kind::vector))
    return fmt::format("{}({}, {}, {})", type.form->function("select"), a, b, mask);
  if (!type.is(Type::Kind::structure)) return fmt::format("select({}, {}, {})", a, b, mask);
  if (type.structure->by_hand)
    fail(place, fmt::format("a {} is set where lanes part, and nothing joins two", type.name));
  type_text(type, true);
  return fmt::format("select_{}({}, {}, {})", type.name, a, b, mask);
}

std::string Writer::mask_of(const Expression& e) {
  if (!varies(e)) return spread(plain(e), e);
  if (e.kind == Kind::binary && compares(e.text)) {
    const std::string first = value(*e.of[0]);
    return fmt::format("MASK_OF({} {} {})", first, e.text, value(*e.of[1]));
  }
  if (e.kind == Kind::binary && joins(e.text)) {
    const char sign = e.text[0];
    if (!varies(*e.of[0])) {  // the second is asked only where C asks it
      const std::size_t at = out_.size();
      const std::string first = plain(*e.of[0]), second = mask_of(*e.of[1]);
      if (out_.size() == at)
        return sign == '&' ? fmt::format("({} ? {} : NO_LANES)", first, second)
                           : fmt::format("({} ? ALL_LANES : {})", first, second);
      out_.resize(at);
    }
    if (!is_guarded(*e.of[1]) && !writes(*e.of[0])) {
      const std::string first = mask_of(*e.of[0]);
      return fmt::format("({} {} {})", first, sign, mask_of(*e.of[1]));
    }
    const std::string is = fresh("is");
    line(fmt::format("const MASK {} = {};", is, mask_of(*e.of[0])));
    return fmt::format("({} {} {})", is, sign,
                       under(sign == '&' ? is : "~" + is, [&] { return mask_of(*e.of[1]); }));
  }
  if (e.kind == Kind::unary && e.text == "!") return "~" + mask_of(*e.of[0]);
  if (e.kind == Kind::cast) {
    if (e.of[0]->type.is(Type::Kind::boolean)) return mask_of(*e.of[0]);
    return fmt::format("MASK_OF({} != 0)", lanes(*e.of[0]));
  }
  if (e.kind == Kind::choose) {
    if (is_guarded(*e.of[1]) || is_guarded(*e.of[2]) || writes(*e.of[0])) return varying_choice(e);
    const std::string asked = mask_of(*e.of[0]), otherwise = mask_of(*e.of[2]);
    return fmt::format("select({}, {}, {})", otherwise, mask_of(*e.of[1]), asked);
  }
  return varying(e);
}

}  // namespace sundog::spmd
