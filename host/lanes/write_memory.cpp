// Tables read at places that vary, and calls.
#include <fmt/format.h>

#include "lanes/writer.h"

namespace sundog::spmd {

using Kind = Expression::Kind;

/// Whether e is read from a table at a place that varies.
bool Writer::is_gathered(const Expression& e) {
  switch (e.kind) {
    case Kind::member:
      return e.arrow ? e.of[0]->type.is_table() && varies(*e.of[0]) : is_gathered(*e.of[0]);
    case Kind::component:
      return is_gathered(*e.of[0]);
    case Kind::index:
      if (e.of[0]->type.is_table()) return varies(*e.of[1]) || varies(*e.of[0]);
      return is_gathered(*e.of[0]);
    default:
      return false;
  }
}

std::string Writer::index_of(const Expression& e) {
  const std::string text = lanes(e);
  return e.type.is(Type::Kind::natural) ? fmt::format("AS_MASK({})", text) : text;
}

/// table[index].member.x: words at a place of each lane. `extra`: words behind it; `whole`: all parts.
std::string Writer::gather(const Expression& e, int extra, bool whole) {
  if (e.type.is(Type::Kind::vector) && whole) {
    std::string all;
    for (int i = 0; i < e.type.form->parts; ++i) all += (i ? ", " : "") + gather(e, i, false);
    return fmt::format("real{}({})", e.type.form->parts, all);
  }
  const Type::Kind part = e.type.is(Type::Kind::vector) ? e.type.part : e.type.kind;
  if (e.type.is(Type::Kind::vector) && !e.type.form->prefix.empty())
    fail(e.place, fmt::format("a {} is in no table", e.type.name));
  int offset = 4 * extra, stride = 0;
  std::string table, index;
  for (const Expression* at = &e; stride == 0;) {
    const Expression& base = *at->of[0];
    if (at->kind == Kind::component) {
      offset += 4 * static_cast<int>(std::string("xyzw").find(at->text));
    } else if (at->kind == Kind::member) {
      const Type& whole_type = at->arrow ? *base.type.of : base.type;
      offset += offset_of(*whole_type.structure, at->text);
      if (at->arrow) {
        std::tie(table, index) = table_and_index(base);
        stride = size_of(whole_type);
      }
    } else if (at->kind == Kind::index && base.type.is_table()) {
      std::tie(table, index) = table_and_index(base);
      const std::string more = index_of(*at->of[1]);
      index = index.empty() ? more : fmt::format("({} + {})", index, more);
      stride = size_of(*base.type.of);
    } else if (at->kind == Kind::index && at->of[1]->kind == Kind::number) {
      offset += std::stoi(at->of[1]->digits, nullptr, 0) * size_of(at->type);
    } else {
      fail(at->place, "a table is read at a place that varies by an index of the table alone");
    }
    at = &base;
  }
  std::string words = stride == 4 ? index : fmt::format("{} * {}", index, stride / 4);
  if (offset != 0) words = fmt::format("{} + {}", words, offset / 4);
  const std::string mask = s_.masked ? mask_ : "ALL_LANES";
  switch (part) {
    case Type::Kind::real:
      return fmt::format("gather_floats((__global const float*)({}), {}, {})", table, words, mask);
    case Type::Kind::integer:
      return fmt::format("gather_words((__global const u32*)({}), {}, {})", table, words, mask);
    case Type::Kind::natural:
      return fmt::format("AS_UINTS(gather_words((__global const u32*)({}), {}, {}))", table, words, mask);
    default:
      fail(e.place, fmt::format("{} cannot be read at a place that varies", name_of(e.type)));
  }
}

/// A pointer to a table: what is alike in all lanes, and an index of each lane, which may be empty.
std::pair<std::string, std::string> Writer::table_and_index(const Expression& e) {
  if (!varies(e)) return {plain(e), ""};
  if (e.kind == Kind::variable)
    if (const auto kept = tables_.find(e.variable); kept != tables_.end()) return {kept->second, e.text};
  if (e.kind == Kind::binary && e.text == "+" && !varies(*e.of[0]))
    return {plain(*e.of[0]), index_of(*e.of[1])};
  if (e.kind == Kind::unary && e.text == "&" && e.of[0]->kind == Kind::index && !varies(*e.of[0]->of[0]))
    return {plain(*e.of[0]->of[0]), index_of(*e.of[0]->of[1])};
  fail(e.place, "a pointer that varies is a table and an index");
}

std::string Writer::call(const Expression& e) {
  if (!e.function) return built_in(e);
  if (!e.function->body) return hand_written(e);
  const std::vector<bool> vary = s_.arguments_of(e, frames_);
  const Specialisation& called = all_.of(*e.function, vary);
  std::string all;
  for (std::size_t i = 0; i < e.of.size(); ++i) {
    const Expression& given = *e.of[i];
    const std::string text = given.type.is_own_pointer() || given.type.is(Type::Kind::array) ? pointed(given)
                             : vary[i] || called.varies(e.function->parameters[i])           ? lanes(given)
                                                                                             : plain(given);
    all += (all.empty() ? "" : ", ") + text;
  }
  if (called.masked) all += (all.empty() ? "" : ", ") + mask_;
  return fmt::format("{}({})", called.name, all);
}

std::string Writer::built_in(const Expression& e) {
  static const std::map<std::string, std::string> names{
      {"as_int", "AS_MASK"},        {"as_float", "AS_REAL"},        {"as_uint", "AS_UINTS"},
      {"convert_float", "TO_REAL"}, {"convert_int_rtz", "TO_MASK"}, {"convert_uint_rtz", "REAL_TO_UINTS"}};
  std::string all;
  const bool v = varies(e);
  for (const ExpressionPtr& given : e.of)
    all += (all.empty() ? "" : ", ") + (v ? lanes(*given) : plain(*given));
  const auto found = names.find(e.text);
  return fmt::format("{}({})", v && found != names.end() ? found->second : e.text, all);
}

std::string Writer::hand_written(const Expression& e) {
  const Function& f = *e.function;
  std::string all;
  std::size_t i = 0;
  for (const Variable* parameter : f.parameters) {
    if (!all.empty()) all += ", ";
    all += parameter->here ? mask_ : argument(*e.of[i++], *parameter, f.takes_mask);
  }
  return fmt::format("{}({})", f.lanes, all);
}

std::string Writer::argument(const Expression& e, const Variable& parameter, bool takes_mask) {
  if (e.type.is_own_pointer() || e.type.is(Type::Kind::array)) return pointed(e);
  if (parameter.uniform || e.type.is(Type::Kind::pointer)) return plain(e);
  const std::string text = lanes(e);
  // Masks of what is written by hand are among the lanes that are there.
  return parameter.type.is(Type::Kind::boolean) && takes_mask ? fmt::format("{} & {}", mask_, text) : text;
}

std::string Writer::pointed(const Expression& e) {
  for (const Expression* at = &e; !at->of.empty(); at = at->of[0].get())
    if (at->kind == Kind::index && varies(*at->of[1])) fail(at->place, "a pointer to an element that varies");
  if (e.kind == Kind::unary && e.text == "&") return "&" + place_of(*e.of[0]);
  return place_of(e);
}

}  // namespace sundog::spmd
