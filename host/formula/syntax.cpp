// Recursive-descent parser of the formula language; FormulaLimits::nesting bounds its depth.
#include "formula/syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formula/lexer.h"

namespace sundog {
namespace {

/// A hint for a reserved word, which authors bring along from shading languages.
std::string_view instead_of(std::string_view word, const Token& next) {
  if (word == "for" || word == "while" || word == "do")
    return ": a map is one iteration, and no text has loops";
  if (word == "if" || word == "else") return ": a ? b : c chooses a value";
  if (word == "return") return ": a text ends in its expression, without a word before it";
  return next.kind == Token::Kind::name ? ": variables are named without their type"
                                        : "; choose another name";
}

class Parser {
 public:
  explicit Parser(std::string_view text) : tokens_(tokens_of(text)) {}

  std::vector<Statement> statements() {
    std::vector<Statement> result;
    while (skip_ends(), here().kind != Token::Kind::end) result.push_back(next_statement(result.size()));
    return result;
  }

  FormulaBody body() {
    FormulaBody result;
    while (skip_ends(), starts_statement())
      result.statements.push_back(next_statement(result.statements.size()));
    if (here().kind == Token::Kind::name && tokens_[at_ + 1].kind == Token::Kind::name) refuse_reserved();
    result.result = expression();
    skip_ends();
    if (here().kind != Token::Kind::end) fail(here(), "expected the end after the expression, " + found());
    return result;
  }

 private:
  struct Nested {  // counts recursion depth
    explicit Nested(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > FormulaLimits::nesting)
        fail(parser_.here(), "nested deeper than " + std::to_string(FormulaLimits::nesting) + " levels");
    }
    ~Nested() { --parser_.depth_; }
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;
    Parser& parser_;
  };

  [[noreturn]] static void fail(const Token& token, const std::string& what) {
    throw FormulaError(token.place.line, token.place.column, what);
  }
  static std::string quoted(const Token& token) {
    if (token.kind == Token::Kind::end) return "the end";
    if (token.kind == Token::Kind::end_of_statement) return "the statement's end";
    return "'" + token.text + "'";
  }
  std::string found() const {
    const bool power = is("*") && at_ > 0 && tokens_[at_ - 1].text == "*";
    const bool both = here().text == "and", one = here().text == "or";
    return "found " + quoted(here()) +
           (power  ? ": powers are written a ^ n"
            : both ? ": write &&"
            : one  ? ": write ||"
                   : "");
  }
  void refuse_reserved() const {
    if (here().kind == Token::Kind::name && is_reserved_word(here().text))
      fail(here(),
           fmt::format("'{}' is a reserved word{}", here().text, instead_of(here().text, tokens_[at_ + 1])));
  }
  const Token& here() const { return tokens_[at_]; }
  bool is(std::string_view sign) const { return here().kind == Token::Kind::sign && here().text == sign; }
  bool accept(std::string_view sign) {
    if (!is(sign)) return false;
    ++at_;
    return true;
  }
  void expect(std::string_view sign) {
    if (!accept(sign)) fail(here(), "expected '" + std::string(sign) + "', " + found());
  }
  void skip_ends() {
    while (here().kind == Token::Kind::end_of_statement) ++at_;
  }
  std::string name() {
    if (here().kind != Token::Kind::name) fail(here(), "expected a name, found " + quoted(here()));
    return tokens_[at_++].text;
  }

  /// Whether "name =" or "name.x =" comes next.
  bool starts_statement() const {
    const auto sign_at = [&](std::size_t i, std::string_view sign) {
      return i < tokens_.size() && tokens_[i].kind == Token::Kind::sign && tokens_[i].text == sign;
    };
    return here().kind == Token::Kind::name &&
           (sign_at(at_ + 1, "=") || (sign_at(at_ + 1, ".") && sign_at(at_ + 3, "=")));
  }
  Statement next_statement(std::size_t before) {
    if (before == FormulaLimits::statements)
      fail(here(), "a formula may have " + std::to_string(FormulaLimits::statements) + " statements");
    return statement();
  }

  Statement statement() {
    Statement s;
    s.place = here().place;
    refuse_reserved();
    s.target = name();
    if (accept(".")) s.members = name();
    if (is("(")) fail(here(), "expected a statement \"name = expression\"");
    for (const std::string_view sign : {"+", "-", "*", "/"})
      if (is(sign) && tokens_[at_ + 1].text == "=")
        fail(here(), fmt::format("expected '=', found '{1}=': write {0} = {0} {1} ...",
                                 s.members.empty() ? s.target : s.target + "." + s.members, sign));
    expect("=");
    s.value = expression();
    if (here().kind != Token::Kind::end_of_statement)
      fail(here(), "expected an operator or the statement's end, " + found());
    return s;
  }

  static Expression make(Expression::Kind kind, SourcePlace place, std::string text,
                         std::vector<Expression> operands) {
    int depth = 1;
    for (const Expression& operand : operands) depth = std::max(depth, operand.depth + 1);
    if (depth > FormulaLimits::tree_depth)
      throw FormulaError(place.line, place.column, "the expression is too long; give parts of it names");
    return {kind, place, std::move(text), 0, std::move(operands), depth};
  }

  Expression expression() {
    const Nested nested(*this);
    Expression condition = binary(0);
    if (!is("?")) return condition;
    const SourcePlace place = here().place;
    expect("?");
    Expression yes = expression();
    expect(":");
    Expression no = expression();
    std::vector<Expression> operands;
    operands.push_back(std::move(condition));
    operands.push_back(std::move(yes));
    operands.push_back(std::move(no));
    return make(Expression::Kind::choose, place, "?", std::move(operands));
  }

  Expression binary(std::size_t level) {
    static const std::array<std::vector<std::string_view>, 5> levels{
        {{"||"}, {"&&"}, {"<", ">", "<=", ">=", "==", "!="}, {"+", "-"}, {"*", "/"}}};
    if (level == levels.size()) return unary();
    Expression left = binary(level + 1);
    for (;;) {
      const auto& signs = levels[level];
      if (here().kind != Token::Kind::sign ||
          std::find(signs.begin(), signs.end(), here().text) == signs.end())
        return left;
      const Token sign = tokens_[at_++];
      std::vector<Expression> operands;
      operands.push_back(std::move(left));
      operands.push_back(binary(level + 1));
      left = make(Expression::Kind::binary, sign.place, sign.text, std::move(operands));
    }
  }

  Expression unary() {
    const Nested nested(*this);
    const SourcePlace place = here().place;
    for (const auto& [sign, kind] :
         {std::pair{"-", Expression::Kind::negate}, {"!", Expression::Kind::opposite}})
      if (accept(sign)) {
        std::vector<Expression> operands;
        operands.push_back(unary());
        return make(kind, place, sign, std::move(operands));
      }
    accept("+");
    return power();
  }

  Expression power() {
    Expression base = postfix();
    if (!is("^")) return base;
    const SourcePlace place = here().place;
    expect("^");
    std::vector<Expression> operands;
    operands.push_back(std::move(base));
    operands.push_back(unary());
    return make(Expression::Kind::binary, place, "^", std::move(operands));
  }

  Expression postfix() {
    Expression value = primary();
    while (is(".")) {
      const SourcePlace place = here().place;
      expect(".");
      std::vector<Expression> operands;
      operands.push_back(std::move(value));
      value = make(Expression::Kind::member, place, name(), std::move(operands));
    }
    return value;
  }

  Expression primary() {
    const Token token = here();
    if (token.kind == Token::Kind::number) {
      ++at_;
      return {Expression::Kind::number, token.place, token.text, token.value, {}, 1};
    }
    if (accept("(")) {
      Expression value = expression();
      expect(")");
      return value;
    }
    if (token.kind != Token::Kind::name) fail(token, "expected a value, " + found());
    for (const std::string_view word : {"if", "else", "for", "while", "do", "return"})
      if (token.text == word) refuse_reserved();
    ++at_;
    if (!accept("(")) return make(Expression::Kind::name, token.place, token.text, {});
    std::vector<Expression> operands;
    if (!is(")")) do
        operands.push_back(expression());
      while (accept(","));
    expect(")");
    return make(Expression::Kind::call, token.place, token.text, std::move(operands));
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::vector<Statement> parse_statements(std::string_view text) { return Parser(text).statements(); }
FormulaBody parse_body(std::string_view text) { return Parser(text).body(); }

bool is_reserved_word(std::string_view word) {
  static constexpr std::string_view words[] = {
      "kernel",    "global",   "local",     "constant",  "private",   "read_only", "write_only", "read_write",
      "uniform",   "pipe",     "image1d_t", "image2d_t", "image3d_t", "sampler_t", "event_t",    "queue_t",
      "quad",      "complex",  "imaginary", "bool",      "char",      "uchar",     "short",      "ushort",
      "int",       "uint",     "long",      "ulong",     "float",     "double",    "void",       "size_t",
      "signed",    "unsigned", "auto",      "break",     "case",      "const",     "continue",   "default",
      "do",        "else",     "enum",      "extern",    "for",       "goto",      "if",         "inline",
      "register",  "restrict", "return",    "sizeof",    "static",    "struct",    "switch",     "typedef",
      "union",     "volatile", "while",     "include",   "define",    "pragma",    "asm",        "typeof",
      "attribute", "vec3",     "quat",      "pi"};
  for (const std::string_view reserved : words)
    if (word == reserved) return true;
  if (word.starts_with("__") || word.starts_with("get_global") || word.starts_with("get_local")) return true;
  // int4, float16 and so on
  const auto digits = word.find_first_of("0123456789");
  return digits != std::string_view::npos && digits > 0 &&
         word.find_first_not_of("0123456789", digits) == std::string_view::npos &&
         word.substr(0, digits) != "vec" && is_reserved_word(word.substr(0, digits)) &&
         word.substr(0, digits) != "pi" && word.substr(0, digits) != "quat";
}

}  // namespace sundog
