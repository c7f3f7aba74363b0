// PNG files written by this test, a filter a row, against their pixels; and those that are broken.
#include <base/pixels/stored_image.h>
#include <zlib.h>

#include <array>
#include <cstdlib>
#include <string>

#include "catch.h"

using namespace sundog;

namespace {

using Samples = std::vector<std::uint8_t>;

std::string big_endian_word(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

std::string png_chunk(const std::string& type, const std::string& content) {
  const std::string whole = type + content;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(whole.data()), static_cast<uInt>(whole.size()));
  return big_endian_word(static_cast<std::uint32_t>(content.size())) + whole +
         big_endian_word(static_cast<std::uint32_t>(sum));
}

/// The filters of the specification's section 9.2, as it states them.
int guess(int filter, int left, int up, int corner) {
  if (filter == 1) return left;
  if (filter == 2) return up;
  if (filter == 3) return (left + up) / 2;
  if (filter != 4) return 0;
  const int p = left + up - corner, a = std::abs(p - left), b = std::abs(p - up), c = std::abs(p - corner);
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

/// Rows of `columns` pixels of `channels` bytes, row y by the filter (y + first) % 5.
std::string filtered_rows(const Samples& pixels, std::size_t columns, std::size_t channels,
                          std::size_t first) {
  const std::size_t row = columns * channels;
  std::string rows;
  for (std::size_t y = 0; y < pixels.size() / row; ++y) {
    const int filter = static_cast<int>((y + first) % 5);
    rows += static_cast<char>(filter);
    for (std::size_t i = 0; i < row; ++i) {
      const auto at = [&](std::size_t back, bool above) {
        return i < back || (above && y == 0) ? 0 : int{pixels[(y - (above ? 1 : 0)) * row + i - back]};
      };
      rows += static_cast<char>(pixels[y * row + i] -
                                guess(filter, at(channels, false), at(0, true), at(channels, true)));
    }
  }
  return rows;
}

struct Written {
  std::string bytes;
  std::size_t first_data;  // where the first IDAT chunk begins
};

/// In IDAT chunks of at most `piece` bytes.
Written written_png(std::uint32_t columns, std::uint32_t rows, std::size_t channels,
                    const std::string& filtered, std::size_t piece) {
  std::string packed(compressBound(filtered.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(filtered.data()),
           filtered.size());
  packed.resize(size);
  const char color = channels == 1 ? 0 : channels == 3 ? 2 : 6;
  Written png;
  png.bytes = "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", big_endian_word(columns) + big_endian_word(rows) +
                                                          '\x08' + color + std::string(3, '\0'));
  png.first_data = png.bytes.size();
  for (std::size_t at = 0; at < packed.size(); at += piece)
    png.bytes += png_chunk("IDAT", packed.substr(at, piece));
  png.bytes += png_chunk("IEND", "");
  return png;
}

Samples made_pixels(std::size_t count) {
  Samples pixels(count);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < count; ++i) {
    state = state * 1664525u + 1013904223u;
    pixels[i] = i % 7 < 3 ? static_cast<std::uint8_t>(state >> 24) : static_cast<std::uint8_t>(3 * i);
  }
  return pixels;
}

Samples with_alpha(const Samples& rgb) {
  Samples out;
  for (std::size_t i = 0; i < rgb.size(); i += 3)
    out.insert(out.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 255});
  return out;
}

bool is_error(const std::string& bytes) {
  try {
    decode_stored(bytes);
  } catch (const std::exception&) {
    return true;
  }
  return false;
}

}  // namespace

TEST_CASE("the pixels of a PNG are what its filters say") {
  for (const std::size_t channels : {1, 3, 4})
    for (const std::size_t columns : {1, 2, 3, 17})
      for (const std::size_t first : {0, 1, 2, 3, 4}) {
        INFO(channels << " channels, " << columns << " columns, first filter " << first);
        const std::uint32_t rows = 11;
        const Samples pixels = made_pixels(rows * columns * channels);
        const std::string filtered = filtered_rows(pixels, columns, channels, first);
        for (const std::size_t piece : {std::size_t{9}, std::size_t{1} << 20}) {
          const Written png =
              written_png(static_cast<std::uint32_t>(columns), rows, channels, filtered, piece);
          const StoredImage image = decode_stored(png.bytes);
          CHECK(image.channels == (channels == 1 ? 1 : 4));
          CHECK(image.data == (channels == 3 ? with_alpha(pixels) : pixels));
        }
      }
}

TEST_CASE("a PNG with a filter that does not exist, a wrong sum or too few rows is an error") {
  const Samples pixels = made_pixels(6 * 5 * 3);
  std::string filtered = filtered_rows(pixels, 6, 3, 0);
  const Written good = written_png(6, 5, 3, filtered, 20);
  CHECK_FALSE(is_error(good.bytes));
  CHECK(is_error(written_png(6, 6, 3, filtered, 20).bytes));
  std::string wrong = good.bytes;
  wrong[good.first_data + 8] ^= 1;  // in the first IDAT's content
  CHECK(is_error(wrong));
  CHECK(is_error(good.bytes.substr(0, good.first_data + 30)));
  filtered[0] = 5;
  CHECK(is_error(written_png(6, 5, 3, filtered, 20).bytes));
}
