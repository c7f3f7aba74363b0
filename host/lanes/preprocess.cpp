// Blanks comments, splits lines into tokens with their places, handles directives, and expands macros in each
// stretch between two directives in one go.
#include "lanes/preprocess.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"

namespace sundog::spmd {

void fail(const Place& place, std::string_view what) {
  if (!place.file) throw BuildError(std::string(what), "");
  throw BuildError(fmt::format("{}:{}:{}: {}", *place.file, place.line, place.column, what), "");
}

namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)); }
bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool continues_name(char c) { return begins_name(c) || is_digit(c); }

/// Replaces comments by spaces and line continuations by '\v'.
std::string whole_lines(std::string text) {
  for (std::size_t at = text.find("\\\n"); at != std::string::npos; at = text.find("\\\n", at))
    text.replace(at, 2, " \v");
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const bool is_block = text[i + 1] == '*';
    if (text[i] != '/' || (!is_block && text[i + 1] != '/')) continue;
    const std::size_t end = is_block ? std::min(text.find("*/", i + 2), text.size() - 2) + 2
                                     : std::min(text.find('\n', i), text.size());
    for (; i < end; ++i)
      if (!is_space(text[i])) text[i] = ' ';
    --i;  // another comment may follow at once
  }
  return text;
}

/// The token that `text` begins with; its place is not set.
Token first_token(std::string_view text) {
  const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : ' '; };
  const auto token = [&](Token::Kind kind, std::size_t n) {
    return Token{kind, std::string(text.substr(0, n)), {}, ""};
  };
  std::size_t n = 0;
  if (begins_name(text[0])) {
    while (continues_name(at(n))) ++n;
    return token(Token::Kind::name, n);
  }
  if (is_digit(text[0]) || (text[0] == '.' && is_digit(at(1)))) {
    const std::string_view exponents = text.starts_with("0x") ? "p" : "eEpP";
    const auto signs_exponent = [&] {
      return n > 0 && (at(n) == '+' || at(n) == '-') && exponents.find(text[n - 1]) != std::string_view::npos;
    };
    while (continues_name(at(n)) || at(n) == '.' || signs_exponent()) ++n;
    return token(Token::Kind::number, n);
  }
  for (const std::string_view sign :
       {"<<=", ">>=", "...", "->", "++", "--", "<<", ">>", "<=", ">=", "==", "!=",
        "&&",  "||",  "+=",  "-=", "*=", "/=", "%=", "&=", "|=", "^=", "##"})
    if (text.starts_with(sign)) return token(Token::Kind::sign, sign.size());
  return token(Token::Kind::sign, 1);
}

/// Splits a logical line that begins at `place` into tokens, and advances `place` to the next line.
Tokens tokens_of(std::string_view text, Place& place) {
  Tokens out;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '\v') {
      ++place.line;
      begin = at + 1;
    }
    if (is_space(text[at])) {
      ++at;
      continue;
    }
    out.push_back(first_token(text.substr(at)));
    out.back().place = {place.file, place.line, static_cast<int>(at - begin) + 1};
    at += out.back().text.size();
  }
  ++place.line;
  return out;
}

/// Reads a macro's arguments from the bracket at `open` on; returns the position of the closing one.
std::size_t read_arguments(const Tokens& in, std::size_t open, std::vector<Tokens>& arguments) {
  arguments.emplace_back();
  int depth = 0;
  for (std::size_t i = open; i < in.size(); ++i) {
    if (in[i].is("(") && depth++ == 0) continue;
    if (in[i].is(")") && --depth == 0) return i;
    if (in[i].is(",") && depth == 1)
      arguments.emplace_back();
    else
      arguments.back().push_back(in[i]);
  }
  fail(in[open].place, "the arguments of a macro have no ')'");
}

}  // namespace

Preprocessor::Preprocessor(ReadFile read, std::function<bool(const std::string&)> keeps_names)
    : read_(std::move(read)), keeps_names_(std::move(keeps_names)) {
  for (const char* name : {"__OPENCL_VERSION__", "__OPENCL_C_VERSION__"})
    macros_[name].body = {{Token::Kind::number, "120", {}, ""}};
}

Tokens Preprocessor::tokens_of(const std::string& path) {
  file(path, {});
  Token end;
  if (!out_.empty()) end.place = out_.back().place;
  out_.push_back(std::move(end));
  return std::exchange(out_, {});
}

std::set<std::string> Preprocessor::files_of(const std::string& path) const {
  std::set<std::string> all;
  std::vector<std::string> next{path};
  while (!next.empty()) {
    const std::string one = std::move(next.back());
    next.pop_back();
    if (all.insert(one).second) next.insert(next.end(), includes_.at(one).begin(), includes_.at(one).end());
  }
  return all;
}

void Preprocessor::file(const std::string& path, const Place& from) {
  if (!includes_.try_emplace(path).second) return;
  std::string text;
  try {
    text = whole_lines(read_(path));
  } catch (const std::exception& error) {
    if (!from.file) throw;
    fail(from, error.what());
  }
  const std::string* name = &paths_.emplace_back(path);
  Place place{name, 1, 1};
  const std::size_t depth = open_.size();
  for (std::size_t at = 0, end; at < text.size(); at = end + 1) {
    end = std::min(text.find('\n', at), text.size());
    const Place first = place;
    const Tokens words = spmd::tokens_of(std::string_view(text).substr(at, end - at), place);
    if (!words.empty() && words[0].is("#"))
      directive(words, first);
    else if (is_active())
      pending_.insert(pending_.end(), words.begin(), words.end());
  }
  flush();
  if (open_.size() != depth) fail({name, place.line, 1}, "an #if has no #endif");
}

bool Preprocessor::is_active() const { return std::ranges::find(open_, false) == open_.end(); }

void Preprocessor::flush() {
  expand(pending_, {}, out_);
  pending_.clear();
}

void Preprocessor::directive(Tokens words, const Place& place) {
  flush();
  const std::string what = words.size() > 1 ? words[1].text : "";
  words.erase(words.begin(), words.begin() + std::min<std::ptrdiff_t>(2, std::ssize(words)));
  if (what.starts_with("if") && !keeps_names_(*place.file))
    fail(place, "a plain file is read once, and asks for features by if (HAS_...): #{}", what);
  if (what == "if") {
    open_.push_back(is_active() && condition(words, place));
  } else if (what == "else" || what == "endif") {
    if (open_.empty()) fail(place, "#{} without an #if", what);
    open_.back() = !open_.back();
    if (what == "endif") open_.pop_back();
  } else if (what.starts_with("if") || what.starts_with("el")) {
    fail(place, "#{} is not known", what);
  } else if (!is_active()) {
    return;
  } else if (what == "include") {
    std::string path;  // a path in quotation marks: join its tokens
    for (const Token& word : words)
      if (!word.is("\"")) path += word.text;
    if (words.size() < 3 || !words[0].is("\"")) fail(place, "wanted #include \"path\"");
    includes_[*place.file].push_back(path);
    file(path, place);
  } else if (what == "define") {
    define(words, place);
  } else if (what == "undef" && !words.empty()) {
    macros_.erase(words[0].text);
  } else if (what != "pragma") {
    fail(place, "#{} is not known", what);
  }
}

void Preprocessor::define(const Tokens& words, const Place& place) {
  if (words.empty() || words[0].kind != Token::Kind::name) fail(place, "#define wants a name");
  Macro macro;
  std::size_t at = 1;
  const int behind = words[0].place.column + static_cast<int>(words[0].text.size());
  if (words.size() > 1 && words[1].is("(") && words[1].place.line == words[0].place.line &&
      words[1].place.column == behind) {
    macro.parameters.emplace();
    for (at = 2; at < words.size() && !words[at].is(")"); ++at)
      if (!words[at].is(",")) macro.parameters->push_back(words[at].text);
    ++at;
  }
  macro.body.assign(words.begin() + static_cast<std::ptrdiff_t>(std::min(at, words.size())), words.end());
  macro.keeps_name = keeps_names_(*place.file);
  macros_[words[0].text] = std::move(macro);
}

/// Evaluates `defined(X)` and `!defined(X)` joined by && or ||, the only conditions that headers use.
bool Preprocessor::condition(const Tokens& words, const Place& place) const {
  bool result = true, joined_by_or = false;
  for (std::size_t i = 0;; ++i) {
    const bool opposite = i < words.size() && words[i].is("!");
    if (opposite) ++i;
    if (i + 3 >= words.size() || !words[i].is("defined") || !words[i + 1].is("(") || !words[i + 3].is(")"))
      fail(place, "wanted defined(NAME), or several joined by && or ||");
    const bool holds = macros_.contains(words[i + 2].text) != opposite;
    result = joined_by_or ? result || holds : result && holds;
    i += 4;
    if (i >= words.size()) return result;
    joined_by_or = words[i].is("||");
  }
}

void Preprocessor::expand(const Tokens& in, const Names& hidden, Tokens& out) {
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Token& token = in[i];
    const auto found = token.kind == Token::Kind::name && !hidden.contains(token.text)
                           ? macros_.find(token.text)
                           : macros_.end();
    if (found == macros_.end() || (found->second.parameters && (i + 1 >= in.size() || !in[i + 1].is("(")))) {
      out.push_back(token);
      continue;
    }
    const Macro& macro = found->second;
    std::vector<Tokens> arguments;
    if (macro.parameters) i = read_arguments(in, i + 1, arguments);
    Tokens body = substituted(macro, arguments, hidden);
    for (Token& word : body) word.place = token.place;
    Names inner = hidden;
    inner.insert(token.text);
    const std::size_t first = out.size();
    expand(body, inner, out);
    if (macro.keeps_name && !macro.parameters && out.size() == first + 1 &&
        out[first].kind == Token::Kind::number)
      out[first].macro = token.text;
  }
}

Tokens Preprocessor::substituted(const Macro& macro, const std::vector<Tokens>& arguments,
                                 const Names& hidden) {
  Tokens out;
  const auto argument = [&](const Token& word) -> const Tokens* {
    if (!macro.parameters) return nullptr;
    const auto found = std::ranges::find(*macro.parameters, word.text);
    const auto index = static_cast<std::size_t>(found - macro.parameters->begin());
    return index < macro.parameters->size() && index < arguments.size() ? &arguments[index] : nullptr;
  };
  bool joins = false;
  for (std::size_t i = 0; i < macro.body.size(); ++i) {
    const Token& word = macro.body[i];
    if (word.is("##")) {
      joins = true;
      continue;
    }
    const bool pasted = joins || (i + 1 < macro.body.size() && macro.body[i + 1].is("##"));
    Tokens words;
    if (const Tokens* given = argument(word); given && !pasted)
      expand(*given, hidden, words);
    else if (given)
      words = *given;
    else
      words = {word};
    if (joins && !out.empty() && !words.empty()) {
      out.back().text += words[0].text;
      words.erase(words.begin());
    }
    joins = false;
    out.insert(out.end(), words.begin(), words.end());
  }
  return out;
}

}  // namespace sundog::spmd
