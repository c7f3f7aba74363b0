// A C preprocessor for plain kernels and the headers of kernels/shared: includes (each file once), #if of
// defined(...), macros with and without arguments, ##. No strings.
#pragma once
#include <fmt/format.h>

#include <deque>
#include <functional>
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

struct Source {
  Tokens tokens;  // the last one is `end`
  std::deque<std::string> files;
};

/// Throws BuildError with the place. Constants that are a single number keep their name if `keeps_names` is
/// true for the path of the file that defines them.
Source preprocess(const std::string& path, const ReadFile& read,
                  const std::function<bool(const std::string&)>& keeps_names);

}  // namespace sundog::spmd
