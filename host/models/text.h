// The line and word reader of the text formats (OBJ, MTL, PLY, STL, NFF).
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "models/source.h"

namespace sundog::models {

class TextReader {
 public:
  struct Syntax {
    bool hash_comments = true;   // '#' starts a comment, except within rest()
    bool continuations = false;  // '\' at the end of a line continues it
  };

  /// Reads `source` from byte `start`, on line `line`. `source` must outlive the reader.
  TextReader(const Source& source, Syntax syntax, std::size_t start = 0, std::size_t line = 1);

  /// Moves to the next line that contains a word; false at the end of the file.
  bool next_line();

  /// The line's next word; empty at its end.
  std::string_view word();
  /// The next word with ASCII letters in lower case.
  std::string keyword();
  /// The rest of the line, trimmed: a name, which may contain '#'.
  std::string_view rest();
  bool at_line_end();

  /// The next word as a finite number; `what` names it in errors.
  double number(std::string_view what);
  /// number() within float's range.
  double bounded(std::string_view what) { return within_float(number(what), what); }
  float real(std::string_view what) { return static_cast<float>(bounded(what)); }
  /// number() and bounded() that return NaN for infinities and NaN, in the spellings of C and of Microsoft
  /// (1.#QNAN).
  double number_or_nan(std::string_view what);
  double bounded_or_nan(std::string_view what) { return within_float(number_or_nan(what), what); }
  std::int64_t integer(std::string_view what);
  std::uint64_t count(std::string_view what);
  /// Fails if words remain on the line.
  void expect_line_end(std::string_view what);

  std::size_t line() const { return line_; }
  std::size_t bytes_left() const { return source_.bytes.size() - next_; }
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void take_line();
  double within_float(double value, std::string_view what) const;

  const Source& source_;
  Syntax syntax_;
  std::size_t next_;       // the byte after the current line
  std::size_t line_;       // number of the current line's first part
  std::size_t following_;  // number of the line at next_
  std::string_view text_;  // the rest of the current line
  std::string joined_;     // a line joined from several
};

/// The name without a trailing comment, for when the full name does not exist.
std::string_view before_comment(std::string_view name);

}  // namespace sundog::models
