// Structures that plain text declares: as they are, and in lanes with what takes lanes of two.
#include <fmt/format.h>

#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

void with_feature(const Member& member, std::vector<std::string>& out, const std::string& text) {
  if (!member.feature.empty()) out.push_back("#if " + member.feature);
  out.push_back(text);
  if (!member.feature.empty()) out.emplace_back("#endif");
}

}  // namespace

std::vector<std::string> Writer::structure(const Structure& s, bool in_lanes) {
  place_ = s.place;
  const std::string name = in_lanes ? s.lanes : s.name;
  std::vector<std::string> out{fmt::format("typedef struct {} {{", name)};
  const auto is_array = [](const Member& m) { return m.type.is(Type::Kind::array); };
  for (const Member& m : s.members) {
    const std::string type = type_text(is_array(m) ? *m.type.of : m.type, in_lanes && !m.uniform);
    with_feature(
        m, out,
        fmt::format("  {} {}{};", type, m.name, is_array(m) ? fmt::format("[{}]", m.type.length) : ""));
  }
  out.push_back(fmt::format("}} {};", name));
  if (!in_lanes) return out;
  out.push_back(fmt::format("static inline {0} select_{1}({0} a, {0} b, MASK m) {{", name, s.name));
  out.push_back(fmt::format("  {} r;", name));
  for (const Member& m : s.members) {
    const Type& type = is_array(m) ? *m.type.of : m.type;
    const std::string at = m.name + (is_array(m) ? "[i]" : "");
    const bool joins = is_by_hand(type) && type.is(Type::Kind::structure) && !type.structure->join.empty();
    const std::string each = is_array(m) ? fmt::format("for (int i = 0; i < {}; ++i) ", m.type.length) : "";
    const std::string value = m.uniform ? "b." + at
                              : joins   ? "a." + at
                                        : selected(type, "a." + at, "b." + at, "m", s.place);
    const std::string joined =
        joins ? fmt::format(" {}{}(&r.{}, &b.{}, m);", each, type.structure->join, at, at) : "";
    with_feature(m, out, fmt::format("  {}r.{} = {};{}", each, at, value, joined));
  }
  out.emplace_back("  return r;");
  out.emplace_back("}");
  return out;
}

/// One path's, the same in all lanes.
std::vector<std::string> Writer::spread_structure(const Structure& s) {
  std::vector<std::string> out{fmt::format("static inline {} all_{}({} a) {{", s.lanes, s.name, s.name),
                               fmt::format("  {} r;", s.lanes)};
  for (const Member& m : s.members) {
    const bool is_array = m.type.is(Type::Kind::array);
    const std::string at = m.name + (is_array ? "[i]" : ""), from = "a." + at;
    Expression e;
    e.type = is_array ? *m.type.of : m.type;
    with_feature(m, out,
                 fmt::format("  {}r.{} = {};",
                             is_array ? fmt::format("for (int i = 0; i < {}; ++i) ", m.type.length) : "", at,
                             m.uniform ? from : spread(from, e)));
  }
  out.emplace_back("  return r;");
  out.emplace_back("}");
  return out;
}

}  // namespace sundog::spmd
