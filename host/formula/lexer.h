// Tokens of the formula language.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "formula/syntax.h"

namespace sundog {

struct Token {
  enum class Kind { number, name, sign, end_of_statement, end } kind = Kind::end;
  SourcePlace place;
  std::string text;
  double value = 0;
};

/// Splits a text into tokens; the last one is `end`. Newlines inside brackets do not end statements.
std::vector<Token> tokens_of(std::string_view text);

}  // namespace sundog
