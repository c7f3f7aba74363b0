// Structures that plain text declares: as they are, and in lanes with what takes lanes of two.
#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

/// A member, or each element of one that is an array.
struct Part {
  explicit Part(const Member& m) : member(m), type(m.type), name(m.name) {
    if (!m.type.is_array()) return;
    type = *m.type.of;
    name += "[i]";
    each = fmt::format("for (int i = 0; i < {}; ++i) ", m.type.length);
  }
  const Member& member;
  Type type;
  std::string name, each;
};

}  // namespace

/// Lines of `head`, a line for each member where its feature is there, and `end`.
template <class Text>
void Writer::structure_lines(const Structure& s, const std::string& head, const Text& text,
                             const std::string& end) {
  place_ = s.place;
  depth_ = 0;
  line(head);
  for (const Member& m : s.members) {
    if (!m.feature.empty()) line("#if " + m.feature);
    line("  " + text(Part(m)));
    if (!m.feature.empty()) line("#endif");
  }
  line(end);
}

std::vector<Line> Writer::structure(const Structure& s, bool in_lanes) {
  out_.clear();
  const std::string name = in_lanes ? s.lanes : s.name;
  const auto declared = [&](const Part& m) {
    const std::string type = type_text(m.type, in_lanes && !m.member.uniform);
    const int length = m.member.type.length;
    return fmt::format("{} {}{};", type, m.member.name, length > 0 ? fmt::format("[{}]", length) : "");
  };
  structure_lines(s, fmt::format("typedef struct {} {{", name), declared, fmt::format("}} {};", name));
  if (!in_lanes) return std::move(out_);
  const auto joined = [&](const Part& m) {
    const std::string a = "a." + m.name, b = "b." + m.name;
    if (m.type.joins())
      return fmt::format("{0}r.{1} = {2}; {0}{3}(&r.{1}, &{4}, m);", m.each, m.name, a,
                         m.type.structure->join, b);
    return fmt::format("{}r.{} = {};", m.each, m.name,
                       m.member.uniform ? b : selected(m.type, a, b, "m", s.place));
  };
  line("static inline {0} select_{1}({0} a, {0} b, MASK m) {{", name, s.name);
  structure_lines(s, fmt::format("  {} r;", name), joined, "  return r;");
  line("}");
  return std::move(out_);
}

/// One path's, the same in all lanes.
std::vector<Line> Writer::spread_structure(const Structure& s) {
  out_.clear();
  const auto spread_part = [&](const Part& m) {
    const std::string from = "a." + m.name;
    return fmt::format("{}r.{} = {};", m.each, m.name, m.member.uniform ? from : spread(from, m.type));
  };
  line("static inline {} all_{}({} a) {{", s.lanes, s.name, s.name);
  structure_lines(s, fmt::format("  {} r;", s.lanes), spread_part, "  return r;");
  line("}");
  return std::move(out_);
}

}  // namespace sundog::spmd
