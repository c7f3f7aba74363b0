// Parses numbers, and encodes and decodes bytes in URIs.
#pragma once
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace sundog {

/// Parses all of `text` as a number; none for other text, or a number outside the type's range.
template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Decodes a part of a URI (RFC 3986). A '%' without two hexadecimal digits stands for itself, because not
/// all programs encode names.
inline std::string percent_decoded(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const char* digits = text.data() + i + 1;
    const bool coded = text[i] == '%' && i + 2 < text.size() &&
                       std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    bytes += coded ? static_cast<char>(byte) : text[i];
    if (coded) i += 2;
  }
  return bytes;
}

/// Encodes `bytes` as one segment of a URI's path (RFC 3986).
inline std::string percent_encoded(std::string_view bytes) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string text;
  for (const char c : bytes) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    const auto byte = static_cast<unsigned char>(c);
    if (plain)
      text += c;
    else
      text.append({'%', digits[byte >> 4], digits[byte & 15]});
  }
  return text;
}

}  // namespace sundog
