// The exception of the formula language.
#pragma once
#include <stdexcept>
#include <string>

namespace sundog {

/// An error at `line`, `column` (from 1; 0: not in the text).
struct FormulaError : std::runtime_error {
  FormulaError(int line_, int column_, const std::string& what)
      : std::runtime_error(what), line(line_), column(column_) {}
  int line, column;
  std::string section;  // which text: "map", "start", "distance"; empty: the definition itself
};

}  // namespace sundog
