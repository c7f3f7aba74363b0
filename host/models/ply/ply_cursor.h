// Reads PLY's data value by value: one cursor for text and one for both byte orders, with the same interface.
// Non-finite values become NaN.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "models/ply/ply_header.h"
#include "models/text.h"

namespace sundog::models {

/// One element per line; skips lines that begin with "comment".
class AsciiPlyCursor {
 public:
  AsciiPlyCursor(const Source& source, const PlyHeader& header)
      : text_(source, {.hash_comments = false, .continuations = false}, header.data_byte, header.data_line) {}

  void begin_element(std::string_view element) {
    for (;;) {
      if (!text_.next_line()) text_.fail(fmt::format("the file ends before its last {}", element));
      TextReader peek = text_;
      if (peek.word() != "comment") return;
    }
  }
  double value(const PlyProperty& property, PlyType type) {
    const double number = text_.number_or_nan(property.name);
    if (!is_real(type) && number != std::trunc(number))
      fail(fmt::format("{}: a whole number wanted", property.name));
    return number;
  }
  void end_element(std::string_view element) { text_.expect_line_end(element); }
  /// Minimum bytes of a value: a digit and a blank.
  static std::size_t least_bytes(PlyType) { return 2; }
  /// Bytes of an element whose lists have three values each; 0 if elements differ in size.
  static std::size_t bytes_of_triangles(const PlyElement&) { return 0; }
  /// Bytes of an element without lists; 0 if elements differ in size.
  static std::size_t bytes_of_scalars(const PlyElement&) { return 0; }
  void skip(std::size_t) {}
  std::size_t bytes_left() const { return text_.bytes_left() + 1; }  // the last line may lack its newline
  [[noreturn]] void fail(const std::string& what) const { text_.fail(what); }

 private:
  TextReader text_;
};

template <std::endian order>
class BinaryPlyCursor {
 public:
  BinaryPlyCursor(const Source& source, const PlyHeader& header) : source_(source), at_(header.data_byte) {}

  void begin_element(std::string_view) {}
  double value(const PlyProperty&, PlyType type) {
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>();
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return take<std::int16_t>();
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return take<std::int32_t>();
      case PlyType::uint32:
        return take<std::uint32_t>();
      case PlyType::float32:
        return number_or_nan(take<float>());
      case PlyType::float64:
        return number_or_nan(take<double>());
    }
    return 0;
  }
  void end_element(std::string_view) {}
  static std::size_t least_bytes(PlyType type) { return size_of(type); }
  static std::size_t bytes_of_triangles(const PlyElement& element) {
    std::size_t bytes = 0;
    for (const PlyProperty& p : element.properties)
      bytes += p.count_type ? size_of(*p.count_type) + 3 * size_of(p.type) : size_of(p.type);
    return bytes;
  }
  static std::size_t bytes_of_scalars(const PlyElement& element) {
    const bool lists = std::ranges::any_of(element.properties,
                                           [](const PlyProperty& p) { return p.count_type.has_value(); });
    return lists ? 0 : bytes_of_triangles(element);
  }
  void skip(std::size_t bytes) { at_ += bytes; }
  std::size_t bytes_left() const { return source_.bytes.size() - at_; }
  [[noreturn]] void fail(const std::string& what) const { fail_at_byte(source_, at_, what); }

 private:
  template <class Value>
  Value take() {
    if (bytes_left() < sizeof(Value)) fail("the file ends within its data");
    char bytes[sizeof(Value)];
    std::memcpy(bytes, source_.bytes.data() + at_, sizeof(Value));
    if constexpr (order != std::endian::native) std::reverse(bytes, bytes + sizeof(Value));
    at_ += sizeof(Value);
    return std::bit_cast<Value>(bytes);
  }
  static double number_or_nan(double value) {
    return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
  }

  const Source& source_;
  std::size_t at_;
};

}  // namespace sundog::models
