// Preprocesses and parses a file, specialises the functions that its entries call, and writes structures and
// functions behind guards, because several files may generate the same ones.
#include "lanes/lanes.h"

#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

/// Collects lines, with #line directives if wanted.
class Text {
 public:
  Text(bool lines, std::string begin) : text(std::move(begin)), lines_(lines) {}
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
  /// Adds lines that a program may get from several plain files.
  void add_once(const std::string& name, const std::string& feature, const std::vector<Line>& all) {
    add({0, "#ifndef MADE_" + name, {}});
    add({0, "#define MADE_" + name, {}});
    if (!feature.empty()) add({0, "#if " + feature, {}});
    for (const Line& line : all) add(line);
    if (!feature.empty()) add({0, "#endif", {}});
    add({0, "#endif", {}});
  }
  std::string text;

 private:
  bool lines_;
  const std::string* file_ = nullptr;
  int number_ = 0;
};

}  // namespace

bool is_plain(const std::string& path) { return path.starts_with("plain/"); }

Lanes::Lanes(ReadFile read, bool shows_helpers)
    : preprocessor_(std::move(read), [](const std::string& file) { return !is_plain(file); }),
      parser_(is_plain),
      shows_helpers_(shows_helpers) {}

std::vector<Specialisation*> Lanes::specialised(const std::string& path) {
  parser_.read(preprocessor_.tokens_of(path));
  const std::set<std::string> files = preprocessor_.files_of(path);
  std::set<const Specialisation*> called;
  const auto is_own = [&](const Function& f) { return f.body && *f.place.file == path; };
  const auto& functions = parser_.program().functions;
  const bool helpers = shows_helpers_ && std::ranges::none_of(functions, [&](const Function& f) {
                         return f.is_entry && is_own(f);
                       });
  for (const Function& f : functions) {
    if (!(helpers ? is_own(f) : f.is_entry && files.contains(*f.place.file))) continue;
    std::vector<bool> vary;
    for (const Variable* p : f.parameters) vary.push_back(!p->uniform && !p->type.is_table());
    called.insert(&specialisations_.of(f, vary));
  }
  std::vector<Specialisation*> all = specialisations_.done();
  for (auto s = all.rbegin(); s != all.rend(); ++s)
    if (called.contains(*s)) called.insert((*s)->calls.begin(), (*s)->calls.end());
  std::erase_if(all, [&](const Specialisation* s) { return !called.contains(s); });
  return all;
}

std::string Lanes::text(const std::string& path, bool lines, const IsWanted& is_wanted) {
  Text out(lines, fmt::format("// Made of {} in lanes.\n", path));
  // Writing may only request further structures: all called functions are known.
  std::vector<Specialisation*> all = specialised(path);
  std::erase_if(all, [&](const Specialisation* s) { return !is_wanted(s->name); });
  if (all.empty()) return out.text;
  std::vector<std::vector<Line>> functions;
  Writer::Structures used;
  for (Specialisation* s : all) {
    Writer writer(specialisations_, *s);
    functions.push_back(writer.function());
    used.insert(writer.structures().begin(), writer.structures().end());
  }
  Writer writer(specialisations_, *all.front());
  for (const auto& [s, in_lanes] : used) writer.structure(*s, in_lanes);  // finds the structures of members
  used.insert(writer.structures().begin(), writer.structures().end());
  for (const Structure& s : parser_.program().structures) {
    const bool plain = used.contains({&s, false}), in_lanes = used.contains({&s, true});
    const std::string spread = "all_" + s.name;
    if (plain && is_wanted(s.name)) out.add_once(s.name, "", writer.structure(s, false));
    if (in_lanes && is_wanted(s.lanes)) out.add_once(s.lanes, "", writer.structure(s, true));
    if (plain && in_lanes && is_wanted(spread)) out.add_once(spread, "", writer.spread_structure(s));
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    out.add_once(all[i]->name, all[i]->function.feature, functions[i]);
  return out.text;
}

std::string Lanes::explained(const std::string& path) {
  std::string out;
  for (const Specialisation* s : specialised(path)) {
    out += fmt::format("{} ({} operations{})\n", s->name, s->cost, s->masked ? ", takes a mask" : "");
    std::vector<std::pair<const Variable*, std::string>> all(s->why.begin(), s->why.end());
    std::ranges::sort(all, {}, [](const auto& row) {
      return std::tuple(row.first->place.line, row.first->name, row.second);
    });
    for (const auto& [v, why] : all) out += fmt::format("  {} varies: {}\n", v->name, why);
  }
  return out;
}

}  // namespace sundog::spmd
