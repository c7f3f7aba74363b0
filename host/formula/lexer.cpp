// Splits a formula's text into tokens. A line's end ends a statement, except within parentheses.
#include "formula/lexer.h"

#include <array>
#include <charconv>
#include <cmath>

namespace sundog {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  std::vector<Token> run() {
    if (text_.size() > FormulaLimits::characters)
      throw FormulaError(1, 1,
                         "a formula may have " + std::to_string(FormulaLimits::characters) +
                             " characters, this one has " + std::to_string(text_.size()));
    while (skip_space(), at_ < text_.size()) next();
    push(Token::Kind::end_of_statement, "");
    push(Token::Kind::end, "");
    return std::move(tokens_);
  }

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  void advance() {
    if (text_[at_++] == '\n') {
      ++place_.line;
      place_.column = 1;
    } else {
      ++place_.column;
    }
  }
  void skip_space() {
    while (at_ < text_.size()) {
      if (peek() == '/' && peek(1) == '/')
        while (at_ < text_.size() && peek() != '\n') advance();
      else if (peek() == ' ' || peek() == '\t' || peek() == '\r')
        advance();
      else
        return;
    }
  }
  void push(Token::Kind kind, std::string text, double value = 0) {
    tokens_.push_back({kind, place_, std::move(text), value});
  }

  void next() {
    const char c = peek();
    if (c == '\n' || c == ';') {
      if (c == ';' || brackets_ <= 0) push(Token::Kind::end_of_statement, "");
      advance();
    } else if (is_letter(c)) {
      name();
    } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
      number();
    } else {
      sign();
    }
  }

  void name() {
    std::size_t length = 0;
    while (is_letter(peek(length)) || is_digit(peek(length))) ++length;
    if (length > FormulaLimits::name_length)
      throw FormulaError(place_.line, place_.column,
                         "a name may have " + std::to_string(FormulaLimits::name_length) + " characters");
    take(Token::Kind::name, length, 0);
  }

  void number() {
    double value = 0;
    const char *first = text_.data() + at_, *last = text_.data() + text_.size();
    const auto result = std::from_chars(first, last, value, std::chars_format::general);
    if (result.ec != std::errc() || std::abs(value) > 1e30)
      throw FormulaError(place_.line, place_.column, "numbers lie between -1e30 and 1e30");
    const auto length = static_cast<std::size_t>(result.ptr - first);
    if (is_letter(peek(length)))
      throw FormulaError(place_.line, place_.column + static_cast<int>(length),
                         "a number cannot end in a letter; write 2 * x for 2x");
    take(Token::Kind::number, length, value);
  }

  void sign() {
    static constexpr std::array<std::string_view, 6> pairs{"<=", ">=", "==", "!=", "&&", "||"};
    for (const std::string_view pair : pairs)
      if (text_.substr(at_, 2) == pair) return take(Token::Kind::sign, 2, 0);
    const char c = peek();
    if (std::string_view("+-*/^()=<>!?:,.").find(c) == std::string_view::npos) {
      std::string what = "unexpected character";
      std::size_t end = at_ + 1;
      while (end < text_.size() && (text_[end] & 0xC0) == 0x80) ++end;
      if ((c > ' ' && c < 127) || end > at_ + 1)
        what += " '" + std::string(text_.substr(at_, end - at_)) + "'";
      if (end > at_ + 1) what += ": formulas are written in ASCII";
      if (c == '%') what += ": the rest of a division is mod(x, m)";
      if (c == '#') what += ": a formula has no directives and includes nothing";
      if (std::string_view("{}[]").find(c) != std::string_view::npos && c)
        what += ": a formula has only round brackets";
      throw FormulaError(place_.line, place_.column, what);
    }
    brackets_ += c == '(' ? 1 : c == ')' ? -1 : 0;
    take(Token::Kind::sign, 1, 0);
  }

  void take(Token::Kind kind, std::size_t length, double value) {
    push(kind, std::string(text_.substr(at_, length)), value);
    for (std::size_t i = 0; i < length; ++i) advance();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  SourcePlace place_;
  int brackets_ = 0;
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokens_of(std::string_view text) { return Lexer(text).run(); }

}  // namespace sundog
