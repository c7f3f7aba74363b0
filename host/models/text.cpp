// Reads words and numbers of text formats; errors give the line.
#include "models/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/names.h"

namespace sundog::models {
namespace {

constexpr std::string_view blanks = " \t\v\f";

template <class Number>
std::from_chars_result convert(std::string_view word, Number& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  return result.ptr == word.data() + word.size()
             ? result
             : std::from_chars_result{result.ptr, std::errc::invalid_argument};
}

// A word shortened to printable characters for a message.
std::string shown(std::string_view word) {
  std::string text;
  for (const char c : word.substr(0, 40)) text += c >= ' ' && c < 127 ? c : '?';
  return text;
}

}  // namespace

TextReader::TextReader(const Source& source, Syntax syntax, std::size_t start, std::size_t line)
    : source_(source), syntax_(syntax), next_(start), line_(line), following_(line) {}

void TextReader::take_line() {
  const std::string_view bytes = source_.bytes;
  std::size_t end = next_;
  while (end < bytes.size() && bytes[end] != '\n' && bytes[end] != '\r') ++end;
  text_ = bytes.substr(next_, end - next_);
  const bool two = bytes.substr(end, 2) == "\r\n";
  next_ = std::min(end + (two ? 2 : 1), bytes.size());
  ++following_;
}

bool TextReader::next_line() {
  while (next_ < source_.bytes.size()) {
    line_ = following_;
    take_line();
    if (syntax_.continuations && !text_.empty() && text_.back() == '\\') {
      joined_.clear();
      while (!text_.empty() && text_.back() == '\\') {
        joined_ += text_.substr(0, text_.size() - 1);
        joined_ += ' ';
        text_ = {};
        if (next_ < source_.bytes.size()) take_line();
      }
      joined_ += text_;
      text_ = joined_;
    }
    if (!at_line_end()) return true;
  }
  return false;
}

bool TextReader::at_line_end() {
  text_.remove_prefix(std::min(text_.find_first_not_of(blanks), text_.size()));
  return text_.empty() || (syntax_.hash_comments && text_.front() == '#');
}

std::string_view TextReader::word() {
  if (at_line_end()) return {};
  std::size_t end = std::min(text_.find_first_of(blanks), text_.size());
  if (const std::size_t comment = text_.find('#'); syntax_.hash_comments && comment < end)
    if (text_[comment - 1] != '.') end = comment;  // not the one in 1.#QNAN
  const std::string_view word = text_.substr(0, end);
  text_.remove_prefix(end);
  return word;
}

std::string TextReader::keyword() { return lower_case(word()); }

std::string_view TextReader::rest() {
  text_.remove_prefix(std::min(text_.find_first_not_of(blanks), text_.size()));
  if (text_.empty()) return {};
  return text_.substr(0, text_.find_last_not_of(blanks) + 1);
}

double TextReader::number(std::string_view what) {
  const std::string_view found = word();
  double value = 0;
  const auto [end, code] = convert(found, value);
  // Underflow is 0; overflow is an error.
  if (code == std::errc::result_out_of_range &&
      (found.find("e-") != found.npos || found.find("E-") != found.npos))
    return 0;
  if (code != std::errc() || !std::isfinite(value))
    fail(fmt::format("{}: a finite number wanted, found '{}'", what, shown(found)));
  return value;
}

double TextReader::number_or_nan(std::string_view what) {
  TextReader ahead = *this;
  const std::string_view found = ahead.word();
  double value = 0;
  const auto [end, code] = convert(found, value);
  const bool out = code == std::errc() ? !std::isfinite(value) : found.find(".#") != found.npos;
  if (!out) return number(what);
  word();
  return std::numeric_limits<double>::quiet_NaN();
}

double TextReader::within_float(double value, std::string_view what) const {
  if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
    fail(fmt::format("{}: {} is beyond single precision's range", what, value));
  return value;
}

std::int64_t TextReader::integer(std::string_view what) {
  const std::string_view found = word();
  std::int64_t value = 0;
  if (convert(found, value).ec != std::errc())
    fail(fmt::format("{}: a whole number wanted, found '{}'", what, shown(found)));
  return value;
}

std::uint64_t TextReader::count(std::string_view what) {
  const std::int64_t value = integer(what);
  if (value < 0) fail(fmt::format("{}: {} is negative", what, value));
  return static_cast<std::uint64_t>(value);
}

void TextReader::expect_line_end(std::string_view what) {
  if (!at_line_end()) fail(fmt::format("{} ends before '{}'", what, shown(word())));
}

std::string_view before_comment(std::string_view name) {
  for (std::size_t at = name.find('#'); at != name.npos; at = name.find('#', at + 1))
    if (at > 0 && blanks.find(name[at - 1]) != blanks.npos) {
      const std::string_view part = name.substr(0, at);
      return part.substr(0, part.find_last_not_of(blanks) + 1);
    }
  return name;
}

void TextReader::fail(const std::string& what) const {
  models::fail(source_, fmt::format("line {}", line_), what);
}

}  // namespace sundog::models
