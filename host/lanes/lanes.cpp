// See lanes.h.
#include "lanes/lanes.h"

#include <fmt/format.h>

#include <algorithm>

#include "lanes/parse.h"
#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

/// A program with all that its entries call.
struct Made {
  Source source;
  Program program;
  Specialisations specialisations;

  Made(const std::string& path, const ReadFile& read) {
    source = preprocess(path, read, [](const std::string& file) { return !is_plain(file); });
    program = parse(source, is_plain);
    for (const Function& f : program.functions) {
      if (!f.is_entry) continue;
      std::vector<bool> vary;
      for (const Variable* p : f.parameters) vary.push_back(!p->uniform && !p->type.is_table());
      specialisations.of(f, vary);
    }
  }
};

/// Collects lines, with #line directives if wanted.
class Text {
 public:
  explicit Text(bool lines) : lines_(lines) {}
  void add(const Line& line) {
    const Place& p = line.place;
    if (lines_ && p.file && (p.file != file_ || p.line != number_)) {
      text += fmt::format("#line {} \"{}\"\n", p.line, *p.file);
      file_ = p.file;
      number_ = p.line;
    }
    text += std::string(2 * static_cast<std::size_t>(line.depth), ' ') + line.text + "\n";
    ++number_;
  }
  void add(std::string line) { add({0, std::move(line), {}}); }
  /// Lines that a program may have from several plain files.
  void add_once(const std::string& name, const std::string& feature, const std::vector<Line>& all) {
    const std::string guard = "MADE_" + name;
    add("#ifndef " + guard);
    add("#define " + guard);
    if (!feature.empty()) add("#if " + feature);
    for (const Line& line : all) add(line);
    if (!feature.empty()) add("#endif");
    add("#endif");
  }
  std::string text;

 private:
  bool lines_;
  const std::string* file_ = nullptr;
  int number_ = 0;
};

}  // namespace

bool is_plain(const std::string& path) { return path.starts_with("plain/"); }

std::string in_lanes(const std::string& path, const ReadFile& read, bool lines) {
  Made made(path, read);
  std::vector<std::vector<Line>> functions;
  Writer::Structures used;
  // Writing may ask for structures alone: what is called is known.
  for (Specialisation* s : std::vector(made.specialisations.done())) {
    Writer writer(made.specialisations, *s);
    functions.push_back(writer.function());
    used.insert(writer.structures().begin(), writer.structures().end());
  }
  Text out(lines);
  out.text = fmt::format("// Made of {} in lanes.\n", path);
  if (!made.specialisations.done().empty()) {
    Writer writer(made.specialisations, *made.specialisations.done().front());
    for (const auto& [s, lanes] : Writer::Structures(used)) writer.structure(*s, lanes);  // those of members
    used.insert(writer.structures().begin(), writer.structures().end());
    for (const Structure& s : made.program.structures) {
      const bool plain = used.contains({&s, false}), lanes = used.contains({&s, true});
      const auto append = [&](const std::string& name, const std::vector<std::string>& text) {
        std::vector<Line> all;
        for (const std::string& line : text) all.push_back({0, line, s.place});
        out.add_once(name, "", all);
      };
      if (plain) append(s.name, writer.structure(s, false));
      if (lanes) append(s.lanes, writer.structure(s, true));
      if (plain && lanes) append("all_" + s.name, writer.spread_structure(s));
    }
  }
  for (std::size_t i = 0; i < functions.size(); ++i) {
    const Specialisation& s = *made.specialisations.done()[i];
    out.add_once(s.name, s.function.feature, functions[i]);
  }
  return out.text;
}

std::string explained(const std::string& path, const ReadFile& read) {
  Made made(path, read);
  std::string out;
  for (const Specialisation* s : made.specialisations.done()) {
    out += fmt::format("{} ({} operations{})\n", s->name, s->cost, s->masked ? ", takes a mask" : "");
    std::vector<std::pair<const Variable*, std::string>> all(s->why.begin(), s->why.end());
    std::ranges::sort(all, {},
                      [](const auto& row) { return std::pair(row.first->place.line, row.first->name); });
    for (const auto& [v, why] : all) out += fmt::format("  {} varies: {}\n", v->name, why);
  }
  return out;
}

}  // namespace sundog::spmd
