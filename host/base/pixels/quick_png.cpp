// Stores each row as the difference to the row above, a good filter for smooth pictures, and deflates the
// rows (Portable Network Graphics Specification, third edition, sections 5, 9 and 10).
#include "base/pixels/quick_png.h"

#include <libdeflate.h>

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "base/deflate.h"
#include "base/image_io.h"

namespace sundog {
namespace {

constexpr std::size_t most_quick_bytes = std::size_t{1} << 30;
constexpr char filter_up = 2;

/// Floats from 2^-13 to 1 are divided into cells by exponent and leading fraction bits.
constexpr unsigned cell_shift = 16;
constexpr std::uint32_t first_bits = std::uint32_t{127 - 13} << 23, end_bits = std::uint32_t{127} << 23;

struct ByteSteps {
  std::array<float, 257> least{};  // the smallest float for each byte; the last exceeds all
  std::array<std::uint8_t, ((end_bits - first_bits) >> cell_shift) + 1>
      at{};  // the byte at the start of each cell
};

std::uint8_t slow_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(value)));
}

ByteSteps find_steps() {
  ByteSteps table;
  table.least[256] = 2;
  for (unsigned byte = 1; byte < 256; ++byte) {
    std::uint32_t below = 0, from = end_bits;  // converge to neighbours
    while (from - below > 1) {
      const std::uint32_t middle = below + (from - below) / 2;
      (slow_byte(std::bit_cast<float>(middle)) >= byte ? from : below) = middle;
    }
    table.least[byte] = std::bit_cast<float>(from);
  }
  for (std::size_t i = 0; i < table.at.size(); ++i)
    table.at[i] = slow_byte(std::bit_cast<float>(first_bits + (static_cast<std::uint32_t>(i) << cell_shift)));
  return table;
}

std::uint8_t look_up(const ByteSteps& table, float value) {
  if (!(value > 0)) return 0;
  if (value >= 1) return 255;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  std::uint8_t byte = bits < first_bits ? 0 : table.at[(bits - first_bits) >> cell_shift];
  while (value >= table.least[byte + 1u]) ++byte;
  return byte;
}

const ByteSteps& byte_steps() {
  static const ByteSteps table = find_steps();
  return table;
}

/// The rows, each after its filter byte.
std::string filtered_rows(const Image& image) {
  const ByteSteps& table = byte_steps();
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<std::uint8_t> above(3 * width), row(3 * width);
  std::string rows;
  rows.resize((3 * width + 1) * height);
  for (std::size_t y = 0; y < height; ++y) {
    const float* from = image.data.data() + y * width * channels;
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) row[3 * x + c] = look_up(table, from[x * channels + c]);
    char* to = rows.data() + y * (3 * width + 1);
    *to++ = filter_up;
    for (std::size_t i = 0; i < 3 * width; ++i) to[i] = static_cast<char>(row[i] - above[i]);
    above.swap(row);
  }
  return rows;
}

void append_word(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
}

void append_chunk(std::string& bytes, std::string_view type, std::string_view content) {
  append_word(bytes, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = bytes.size();
  bytes.append(type).append(content);
  append_word(bytes, libdeflate_crc32(0, bytes.data() + begin, bytes.size() - begin));
}

}  // namespace

std::uint8_t srgb_byte(float value) { return look_up(byte_steps(), value); }

std::string encode_quick_png(const Image& image) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  if (image.channels < 3) throw std::runtime_error("wanted a picture of colours");
  if (3 * width * height > most_quick_bytes)
    throw std::runtime_error("the image is too large for a PNG; use .exr");
  std::string header;
  append_word(header, static_cast<std::uint32_t>(width));
  append_word(header, static_cast<std::uint32_t>(height));
  header.append({8, 2, 0, 0, 0});  // bits, RGB, deflate, the five filters, rows in order
  std::string bytes = "\x89PNG\r\n\x1a\n";
  append_chunk(bytes, "IHDR", header);
  append_chunk(bytes, "IDAT", deflated(filtered_rows(image)));
  append_chunk(bytes, "IEND", "");
  return bytes;
}

}  // namespace sundog
