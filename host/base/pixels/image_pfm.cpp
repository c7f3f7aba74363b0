// Reads and writes portable float maps (Debevec): "PF" for colour or "Pf" for grey, width, height, and a
// scale whose sign gives the byte order (negative: little-endian); then rows, bottom first.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "base/numbers.h"
#include "base/pixels/image_codecs.h"

namespace sundog {
namespace {

std::uint32_t swap_bytes(std::uint32_t v) {
  return v << 24 | (v & 0xFF00u) << 8 | (v >> 8 & 0xFF00u) | v >> 24;
}

struct Header {
  int width = 0, height = 0, channels = 0;
  bool little_endian = true;
  std::size_t data = 0;  // offset of the samples
};

std::string_view next_word(std::string_view bytes, std::size_t& at) {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t first = bytes.find_first_not_of(space, at);
  if (first == std::string_view::npos) throw std::runtime_error("the PFM header is cut short");
  at = std::min(bytes.find_first_of(space, first), bytes.size());
  return bytes.substr(first, at - first);
}

template <class T>
T number(std::string_view word, const char* what) {
  const auto value = whole_number<T>(word);
  if (!value)
    throw std::runtime_error(fmt::format("PFM header: wanted {}, found '{}'", what, word.substr(0, 20)));
  return *value;
}

Header read_header(std::string_view bytes) {
  Header header;
  std::size_t at = 2;
  header.channels = bytes[1] == 'F' ? 3 : 1;
  header.width = number<int>(next_word(bytes, at), "a width");
  header.height = number<int>(next_word(bytes, at), "a height");
  const float scale = number<float>(next_word(bytes, at), "a scale");
  if (header.width <= 0 || header.height <= 0) throw std::runtime_error("PFM header: the image is empty");
  if (scale == 0 || !std::isfinite(scale))
    throw std::runtime_error("PFM header: the scale is zero or not finite");
  header.little_endian = scale < 0;
  header.data = at + 1;  // one white-space character ends the header
  return header;
}

void check_length(const Header& header, std::size_t size) {
  const auto row = static_cast<std::uint64_t>(header.width) * static_cast<unsigned>(header.channels) * 4;
  const std::uint64_t wanted = row * static_cast<unsigned>(header.height);
  const std::uint64_t found = size > header.data ? size - header.data : 0;
  if (found / row < static_cast<unsigned>(header.height))
    throw std::runtime_error(
        fmt::format("the PFM data is cut short: wanted {} bytes, found {}", wanted, found));
}

}  // namespace

std::string encode_pfm(const Image& image) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  bytes.reserve(bytes.size() + 3 * sizeof(float) * pixels);
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x)
      bytes.append(reinterpret_cast<const char*>(image.pixel(x, y)), 3 * sizeof(float));
  return bytes;
}

Image decode_pfm(std::string_view bytes) {
  const Header header = read_header(bytes);
  check_length(header, bytes.size());
  Image image(header.width, header.height, 4);
  const char* from = bytes.data() + header.data;
  for (int y = header.height - 1; y >= 0; --y)
    for (int x = 0; x < header.width; ++x) {
      float* to = image.pixel(x, y);
      for (int c = 0; c < header.channels; ++c, from += 4) {
        std::uint32_t word = 0;
        std::memcpy(&word, from, 4);
        to[c] = std::bit_cast<float>(header.little_endian ? word : swap_bytes(word));
      }
      if (header.channels == 1) to[1] = to[2] = to[0];
      to[3] = 1;
    }
  return image;
}

}  // namespace sundog
