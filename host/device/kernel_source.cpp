// Expands #include lines. A file is not expanded again within the #if branches that included it. After those
// branches the compiler may not have seen it, so it is expanded again inside an include guard.
#include "device/kernel_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

#include "base/error.h"
#include "device/embedded_kernels.h"
#include "lanes/lanes.h"

namespace sundog {
namespace {

/// The parts of a preprocessor line `# word rest`; word is empty for other lines.
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

/// The path of `#include "path"`; empty for other directives.
std::string included_path(const Directive& directive) {
  if (directive.word != "include" || !directive.rest.starts_with('"')) return {};
  return directive.rest.substr(1, directive.rest.find('"', 1) - 1);
}

std::string guard_name(const std::string& path) {
  std::string name = "SUNDOG_INCLUDED_" + path;
  std::replace_if(name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

class Expander {
 public:
  Expander(const KernelText& kernel, bool in_lanes)
      : generated_(kernel.generated), folder_(kernel.folder), in_lanes_(in_lanes) {
    out = "#line 1 \"defines\"\n";
    for (const auto& [name, value] : kernel.defines) out += fmt::format("#define {} {}\n", name, value);
    expand(kernel.entry);
  }

  std::string out;

 private:
  void expand(const std::string& path) {
    const auto is_wanted = [this](const std::string& name) { return !is_seen(name) && see(name); };
    const std::string text =
        in_lanes_ && spmd::is_plain(path) ? lanes_.text(path, true, is_wanted) : file_text(path);
    open_.push_back(path);
    out += fmt::format("#ifndef {0}\n#define {0}\n#line 1 \"{1}\"\n", guard_name(path), path);
    expand_lines(path, text);
    out += "#endif\n";
    open_.pop_back();
    see(path);
  }

  std::string file_text(const std::string& path) const {
    if (const auto found = generated_.find(path); found != generated_.end()) return found->second;
    return embedded_kernel(path, folder_);
  }

  void expand_lines(const std::string& path, const std::string& text) {
    std::istringstream in(text);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      const Directive directive = parse_directive(line);
      follow_conditional(directive.word);
      const std::string target = included_path(directive);
      if (directive.word == "pragma" && directive.rest == "once") {
        out += "\n";  // compilers warn about #pragma once in a main file
      } else if (target.empty()) {
        out += line + "\n";
      } else if (is_seen(target)) {
        out += "\n";
      } else {
        include(target, fmt::format("{}:{}", path, number));
        out += fmt::format("#line {} \"{}\"\n", number + 1, path);
      }
    }
  }

  /// Enters and leaves branches of an #if.
  void follow_conditional(const std::string& word) {
    const bool begins = word.starts_with("if"), turns = word.starts_with("el"), ends = word == "endif";
    if ((turns || ends) && seen_.size() > 1) seen_.pop_back();
    if (begins || turns) seen_.emplace_back();
  }

  bool is_seen(const std::string& what) const {
    return std::ranges::any_of(seen_, [&](const auto& branch) { return branch.contains(what); });
  }
  bool see(const std::string& what) { return seen_.back().insert(what).second; }

  void include(const std::string& target, const std::string& place) {
    if (std::find(open_.begin(), open_.end(), target) != open_.end())
      throw BuildError(fmt::format("{}: {} includes itself", place, target), "");
    try {
      expand(target);
    } catch (const MissingKernelFile& missing) {
      throw BuildError(fmt::format("{}: {}", place, missing.what()), "");
    }
  }

  const GeneratedFiles& generated_;
  const std::filesystem::path& folder_;
  bool in_lanes_;  // plain files become lanes
  spmd::Lanes lanes_{[this](const std::string& path) { return file_text(path); }};
  std::vector<std::string> open_;               // files being expanded, outermost first
  std::vector<std::set<std::string>> seen_{1};  // files and names of lanes seen in each open #if branch
};

}  // namespace

std::string KernelText::expanded() const { return Expander(*this, true).out; }

std::string KernelText::identity() const {
  return fmt::format("// lanes by {}\n", spmd::revision()) + Expander(*this, false).out;
}

}  // namespace sundog
