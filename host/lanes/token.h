// Tokens of a plain kernel and their places.
#pragma once
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

struct Token {
  enum class Kind { name, number, sign, end };
  Kind kind = Kind::end;
  std::string text;
  Place place;
  std::string macro;  // the header constant that this number replaces
  bool is(std::string_view word) const { return text == word; }
};

using Tokens = std::vector<Token>;

}  // namespace sundog::spmd
