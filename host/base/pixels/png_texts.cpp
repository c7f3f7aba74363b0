// Reads and writes texts in PNG files as iTXt chunks, in UTF-8 (PNG, third edition, 11.3.3.4).
#include <zlib.h>

#include <cstdint>

#include "base/pixels/image_codecs.h"

namespace sundog {
namespace {

// The signature and the header chunk, which comes first.
constexpr std::size_t png_header_end = 8 + 12 + 13;
constexpr std::size_t most_keyword = 79;

std::string four_bytes(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::size_t length_at(std::string_view bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::string text_chunk(const std::string& keyword, const std::string& text) {
  std::string data = "iTXt" + keyword.substr(0, most_keyword);
  data += std::string(5, '\0');  // end of keyword; uncompressed; no language; no translation
  data += text;
  const auto sum = ::crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
  return four_bytes(static_cast<std::uint32_t>(data.size() - 4)) + data +
         four_bytes(static_cast<std::uint32_t>(sum));
}

}  // namespace

std::string with_png_texts(std::string png, const ImageTexts& texts) {
  std::string chunks;
  for (const auto& [keyword, text] : texts) chunks += text_chunk(keyword, text);
  png.insert(png_header_end, chunks);
  return png;
}

ImageTexts decode_png_texts(std::string_view bytes) {
  ImageTexts texts;
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n")) return texts;
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = length_at(bytes, at);
    const std::string_view data = bytes.substr(at + 8, length);
    if (data.size() < length || bytes.substr(at + 4, 4) == "IDAT") break;
    const std::size_t end = data.find('\0');
    if (bytes.substr(at + 4, 4) == "iTXt" && end != data.npos && end + 5 <= data.size())
      texts.emplace_back(data.substr(0, end), data.substr(end + 5));
    at += 12 + length;
  }
  return texts;
}

}  // namespace sundog
