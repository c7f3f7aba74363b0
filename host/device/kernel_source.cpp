// Include expansion. A file that was included where no #if is open is never needed again; one included under
// an #if may not have been seen by the compiler, so it is expanded anew next time, and a guard of its own
// keeps it single.
#include "device/kernel_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "device/embedded_kernels.h"

namespace sundog {
namespace {

/// `# word rest` of a preprocessor line; word is empty for any other line.
struct Directive {
  std::string word, rest;
};

Directive parse_directive(const std::string& line) {
  std::istringstream in(line);
  char hash = 0;
  if (!(in >> hash) || hash != '#') return {};
  Directive directive;
  in >> directive.word;
  in >> std::ws;
  std::getline(in, directive.rest);
  return directive;
}

/// The path of `#include "path"`; empty for anything else.
std::string included_path(const Directive& directive) {
  if (directive.word != "include" || !directive.rest.starts_with('"')) return {};
  return directive.rest.substr(1, directive.rest.find('"', 1) - 1);
}

/// Whether the file's first two directives are `#ifndef X` and `#define X`.
bool has_include_guard(const std::string& text) {
  std::istringstream in(text);
  std::string line, guard;
  while (std::getline(in, line)) {
    const Directive directive = parse_directive(line);
    if (directive.word.empty()) continue;
    if (!guard.empty()) return directive.word == "define" && directive.rest == guard;
    if (directive.word != "ifndef") return false;
    guard = directive.rest;
  }
  return false;
}

std::string guard_name(const std::string& path) {
  std::string name = "SUNDOG_INCLUDED_" + path;
  std::replace_if(name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

class Expander {
 public:
  Expander(const GeneratedFiles& generated, const std::filesystem::path& folder)
      : generated_(generated), folder_(folder) {}

  /// `certain`: the compiler is sure to see this text, for no #if is open.
  void expand(const std::string& path, bool certain) {
    const std::string text = file_text(path);
    const bool guarded = has_include_guard(text);
    open_.push_back(path);
    if (!guarded) out += fmt::format("#ifndef {0}\n#define {0}\n", guard_name(path));
    out += fmt::format("#line 1 \"{}\"\n", path);
    expand_lines(path, text, certain, guarded ? 1 : 0);
    if (!guarded) out += "#endif\n";
    open_.pop_back();
    if (certain) done_.insert(path);
  }

  std::string out;

 private:
  std::string file_text(const std::string& path) const {
    if (const auto found = generated_.find(path); found != generated_.end()) return found->second;
    return embedded_kernel(path, folder_);
  }

  void expand_lines(const std::string& path, const std::string& text, bool certain, int guard_depth) {
    std::istringstream in(text);
    std::string line;
    int depth = 0;
    for (int number = 1; std::getline(in, line); ++number) {
      const Directive directive = parse_directive(line);
      if (directive.word.starts_with("if")) ++depth;
      if (directive.word == "endif") --depth;
      const std::string target = included_path(directive);
      if (target.empty()) {
        out += line + "\n";
      } else if (done_.contains(target)) {
        out += "\n";
      } else {
        include(target, fmt::format("{}:{}", path, number), certain && depth <= guard_depth);
        out += fmt::format("#line {} \"{}\"\n", number + 1, path);
      }
    }
  }

  void include(const std::string& target, const std::string& place, bool certain) {
    if (std::find(open_.begin(), open_.end(), target) != open_.end())
      throw BuildError(fmt::format("{}: {} includes itself", place, target), "");
    try {
      expand(target, certain);
    } catch (const MissingKernelFile& missing) {
      throw BuildError(fmt::format("{}: {}", place, missing.what()), "");
    }
  }

  const GeneratedFiles& generated_;
  const std::filesystem::path& folder_;
  std::vector<std::string> open_;  // the files being expanded, outermost first
  std::set<std::string> done_;
};

}  // namespace

std::string expand_kernel(const std::string& entry, const KernelDefines& defines,
                          const GeneratedFiles& generated, const std::filesystem::path& folder) {
  Expander expander(generated, folder);
  expander.out = "#line 1 \"defines\"\n";
  for (const auto& [name, value] : defines) expander.out += fmt::format("#define {} {}\n", name, value);
  expander.expand(entry, true);
  return expander.out;
}

}  // namespace sundog
