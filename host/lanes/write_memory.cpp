// Writes accesses to tables and arrays at varying places, structures, and calls.
#include "lanes/writer.h"

namespace sundog::spmd {

namespace {

using Kind = Expression::Kind;

}  // namespace

/// Whether e is read from a table at a varying place.
bool Writer::is_gathered(const Expression& e) {
  if (e.kind != Kind::member && e.kind != Kind::component && e.kind != Kind::index) return false;
  if (e.of[0]->type.is_table()) return varies(*e.of[0]) || (e.kind == Kind::index && varies(*e.of[1]));
  return !e.arrow && is_gathered(*e.of[0]);
}

std::string Writer::index_of(const Expression& e) {
  const std::string text = lanes(e);
  return e.type.is_natural() ? fmt::format("AS_MASK({})", text) : text;
}

/// Gathers table[index].member[place].x at the places of all lanes; of a vector, the given part.
std::string Writer::gather(const Expression& e, std::size_t part) {
  int offset = 0, stride = 0;
  std::string table, index, places;
  for (const Expression* at = &e; stride == 0; at = at->of[0].get()) {
    const Expression& base = *at->of[0];
    if (at->kind == Kind::component) part = std::string_view("xyzw").find(at->text[part]);
    if (at->kind == Kind::member) offset += offset_of(*at->whole().structure, at->text);
    if (base.type.is_table()) {
      std::tie(table, index) = table_and_index(base);
      stride = size_of(*base.type.of);
    }
    if (at->kind != Kind::index) continue;
    if (stride > 0) {
      const std::string more = index_of(*at->of[1]);
      index = index.empty() ? more : fmt::format("({} + {})", index, more);
    } else if (at->of[1]->kind == Kind::number) {
      offset += std::stoi(at->of[1]->digits, nullptr, 0) * size_of(at->type);
    } else {
      places += fmt::format(" + {} * {}", index_of(*at->of[1]), size_of(at->type) / 4);
    }
  }
  offset += 4 * static_cast<int>(part);
  std::string words = (stride == 4 ? index : fmt::format("{} * {}", index, stride / 4)) + places;
  if (offset != 0) words = fmt::format("{} + {}", words, offset / 4);
  const Type::Kind kind = e.type.is_vector() ? Type::Kind::real : e.type.kind;
  if (kind < Type::Kind::integer || kind > Type::Kind::real || e.type.is_by_hand())
    fail(e.place, "{} cannot be read at a place that varies", name_of(e.type));
  if (kind == Type::Kind::real)
    return fmt::format("gather_floats((__global const float*)({}), {}, {})", table, words, mask_);
  const std::string all = fmt::format("gather_words((__global const u32*)({}), {}, {})", table, words, mask_);
  return kind == Type::Kind::natural ? fmt::format("AS_UINTS({})", all) : all;
}

/// Splits a pointer to a table into a part that is equal in all lanes and an index per lane, which may be
/// empty.
std::pair<std::string, std::string> Writer::table_and_index(const Expression& e) {
  if (!varies(e)) return {value(e), ""};
  if (const auto kept = tables_.find(e.variable); kept != tables_.end()) return {kept->second, e.text};
  const Expression& of = e.is_unary("&") && e.of[0]->kind == Kind::index ? *e.of[0] : e;
  if ((!of.is_binary("+") && of.kind != Kind::index) || varies(*of.of[0]))
    fail(e.place, "a pointer that varies is a table and an index");
  return {value(*of.of[0]), index_of(*of.of[1])};
}

/// The type of an array's elements, as lanes.h names it, and the place of the element that `lane` accesses.
std::pair<std::string, std::string> Writer::place_in_lane(const Expression& e, const std::string& lane) {
  if (!e.type.is_real() && !e.type.is(Type::Kind::integer))
    fail(e.place, "an element that varies of an array of {}", name_of(e.type));
  const std::string index = simple(*e.of[1]);
  return {e.type.is_real() ? "REAL" : "MASK",
          fmt::format("{}[MASK_LANE({}, {})]", value(*e.of[0]), index, lane)};
}

/// Reads an element of an array, which may vary, at an index that may differ between lanes.
std::string Writer::element(const Expression& e) {
  const std::string name = fresh("element"), lane = fresh("lane");
  const auto [type, place] = place_in_lane(e, lane);
  line("{0} {1} = ({0})(0);", type, name);
  const std::string found = varies(*e.of[0]) ? fmt::format("{}_LANE({}, {})", type, place, lane) : place;
  line("EACH_LANE({0}, {1}) {2}_LANE({3}, {0}) = {4};", lane, mask_, type, name, found);
  return name;
}

/// Writes `to = value` to an array at an index that differs between lanes.
std::string Writer::scatter(const Expression& to, const std::string& value) {
  const std::string name = fresh("value"), lane = fresh("lane");
  const auto [type, place] = place_in_lane(to, lane);
  line("const {} {} = {};", type, name, value);
  line("EACH_LANE({0}, {1}) {2}_LANE({3}, {0}) = {2}_LANE({4}, {0});", lane, mask_, type, place, name);
  return "";
}

std::string Writer::call(const Expression& e) {
  if (!e.function) {
    const bool v = varies(e);
    const BuiltIn& f = *built_in_of(e.text);
    const std::string all =
        joined(e.of, [&](const auto& given) { return v ? lanes(*given) : value(*given); });
    return fmt::format("{}({})", v && !f.lanes.empty() ? f.lanes : e.text, all);
  }
  if (!e.function->body) return hand_written(e);
  const std::vector<bool> vary = s_.arguments_of(e, frames_);
  const Specialisation& called = all_.of(*e.function, vary);
  std::size_t i = 0;
  std::string all = joined(e.of, [&](const ExpressionPtr& given) {
    const bool v = vary[i] || called.varies(e.function->taken[i]);
    ++i;
    if (given->type.is_own_pointer() || given->type.is_array()) return pointed(*given);
    return v ? lanes(*given) : value(*given);
  });
  if (called.masked) all += (all.empty() ? "" : ", ") + mask_;
  return fmt::format("{}({})", called.name, all);
}

std::string Writer::hand_written(const Expression& e) {
  const Function& f = *e.function;
  std::size_t i = 0;
  const std::string all = joined(f.parameters, [&](const Variable* parameter) {
    if (parameter->here) return mask_;
    const Expression& given = *e.of[i++];
    if (given.type.is_own_pointer() || given.type.is_array()) return pointed(given);
    if (parameter->uniform || given.type.is_pointer()) return value(given);
    // Hand-written functions receive masks of active lanes only.
    const bool narrows = parameter->type.is_truth() && f.takes_mask;
    return narrows ? fmt::format("{} & {}", mask_, lanes(given)) : lanes(given);
  });
  return fmt::format("{}({})", f.lanes, all);
}

std::string Writer::pointed(const Expression& e) {
  for (const Expression* at = &e; !at->of.empty(); at = at->of[0].get())
    if (at->kind == Kind::index && varies(*at->of[1])) fail(at->place, "a pointer to an element that varies");
  if (e.is_unary("&")) return "&" + value(*e.of[0]);
  return value(e);
}

// ---- structures: for one path, and in lanes, with functions that select between two

/// Writes `head`, a line for each member, within #if of its feature, and `end`.
template <class Text>
void Writer::member_lines(const Structure& s, const std::string& head, const Text& text, const char* end) {
  place_ = s.place;
  depth_ = 0;
  line(head);
  for (const Member& m : s.members) {
    if (!m.feature.empty()) line("#if " + m.feature);
    line("  " + text(m));
    if (!m.feature.empty()) line("#endif");
  }
  line(end);
}

/// Writes the function `head`, which sets all members of `r`, and each element of arrays, by `text`.
template <class Text>
std::vector<Line> Writer::structure_function(const Structure& s, const std::string& head, const Text& text) {
  line("static inline {} {} {{", s.lanes, head);
  const auto part = [&](const Member& m) {
    if (!m.type.is_array()) return text(m.type, m.name);
    return fmt::format("for (int i = 0; i < {}; ++i) {}", m.type.length, text(*m.type.of, m.name + "[i]"));
  };
  member_lines(s, fmt::format("  {} r;", s.lanes), part, "  return r;");
  line("}");
  return std::move(out_);
}

std::vector<Line> Writer::structure(const Structure& s, bool in_lanes) {
  out_.clear();
  const std::string& name = in_lanes ? s.lanes : s.name;
  const auto declared = [&](const Member& m) {
    const bool is_array = m.type.is_array();
    const std::string type = type_text(is_array ? *m.type.of : m.type, in_lanes);
    return fmt::format("{} {}{};", type, m.name, is_array ? fmt::format("[{}]", m.type.length) : "");
  };
  member_lines(s, fmt::format("typedef struct {} {{", name), declared, ("} " + name + ";").c_str());
  if (!in_lanes) return std::move(out_);
  const auto joined = [&](const Type& type, const std::string& at) {
    const std::string a = "a." + at, b = "b." + at;
    if (type.joins()) return fmt::format("r.{} = {}; {}(&r.{}, &{}, m);", at, a, type.structure->join, at, b);
    return fmt::format("r.{} = {};", at, selected(type, a, b, "m", s.place));
  };
  return structure_function(s, fmt::format("select_{0}({1} a, {1} b, MASK m)", s.name, s.lanes), joined);
}

/// Writes the function that repeats one path's structure in all lanes.
std::vector<Line> Writer::spread_structure(const Structure& s) {
  out_.clear();
  const auto spread_part = [&](const Type& type, const std::string& at) {
    return fmt::format("r.{} = {};", at, spread("a." + at, type));
  };
  return structure_function(s, fmt::format("all_{0}({0} a)", s.name), spread_part);
}

}  // namespace sundog::spmd
