// A C preprocessor for plain kernels and the headers of kernels/shared: includes (each file once), #if of
// defined(...), macros with and without arguments, ##. No strings.
#pragma once
#include <fmt/format.h>

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace sundog::spmd {

/// Line and column start at 1. `file` lives as long as the Source.
struct Place {
  const std::string* file = nullptr;
  int line = 0, column = 0;
};

/// Throws BuildError "file:line:column: what".
[[noreturn]] void fail(const Place& place, std::string_view what);
template <class First, class... Others>
[[noreturn]] void fail(const Place& place, fmt::format_string<const First&, const Others&...> what,
                       const First& first, const Others&... others) {
  fail(place, fmt::format(what, first, others...));
}

struct Token {
  enum class Kind { name, number, sign, end };
  Kind kind = Kind::end;
  std::string text;
  Place place;
  std::string macro;  // the header constant that this number replaces
  bool is(std::string_view word) const { return text == word; }
};

using Tokens = std::vector<Token>;

/// Returns a kernel file's text; throws if there is none.
using ReadFile = std::function<std::string(const std::string& path)>;

/// Throws BuildError with the place. Constants that are a single number keep their name if `keeps_names` is
/// true for the path of the file that defines them.
class Preprocessor {
 public:
  Preprocessor(ReadFile read, std::function<bool(const std::string&)> keeps_names);

  /// The tokens of a file and of its includes, except for files whose tokens it has returned before; the last
  /// token is `end`.
  Tokens tokens_of(const std::string& path);
  /// The file and all that it includes, directly or not.
  std::set<std::string> files_of(const std::string& path) const;

 private:
  struct Macro {
    std::optional<std::vector<std::string>> parameters;  // none: a macro without a list
    Tokens body;
    bool keeps_name = false;
  };
  using Names = std::set<std::string>;

  void file(const std::string& path, const Place& from);
  bool is_active() const;
  void flush();
  void directive(Tokens words, const Place& place);
  void define(const Tokens& words, const Place& place);
  bool condition(const Tokens& words, const Place& place) const;
  void expand(const Tokens& in, const Names& hidden, Tokens& out);
  Tokens substituted(const Macro& macro, const std::vector<Tokens>& arguments, const Names& hidden);

  ReadFile read_;
  std::function<bool(const std::string&)> keeps_names_;
  std::deque<std::string> paths_;                             // file names, for places
  std::map<std::string, std::vector<std::string>> includes_;  // direct includes of each file read
  std::map<std::string, Macro> macros_;
  std::vector<bool> open_;  // whether the branch of each open #if is taken
  Tokens pending_, out_;    // pending_: not yet expanded, because a macro's arguments may span lines
};

}  // namespace sundog::spmd
