// Inflates into the end of the pixels' memory and unfilters rows towards its start, a pixel at a time
// (Portable Network Graphics Specification, third edition, sections 5, 9 and 10).
#include "base/pixels/png_pixels.h"
#include "base/memory.h"

#include <libdeflate.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>

namespace sundog {
namespace {

/// Larger images are left to libspng, which buffers only a row besides the pixels.
constexpr std::size_t most_filtered_bytes = std::size_t{1} << 28;
/// Padding after the filtered rows, because pixels are read four bytes at a time.
constexpr std::size_t slack = 4;

std::uint32_t chunk_word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(at, 4)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

/// The contents of all IDAT chunks, stored in `joined` if there are several; empty if a chunk is broken, a
/// checksum wrong or the end missing.
std::string_view packed_pixels(std::string_view bytes, std::string& joined) {
  std::string_view first;
  std::size_t count = 0;
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = chunk_word(bytes, at);
    if (length > bytes.size() - at - 12) return {};
    const std::string_view type = bytes.substr(at + 4, 4), content = bytes.substr(at + 8, length);
    if (libdeflate_crc32(0, type.data(), length + 4) != chunk_word(bytes, at + 8 + length)) return {};
    if (type == "IEND") return count > 1 ? std::string_view(joined) : first;
    if (type == "IDAT") {
      if (++count == 1) {
        first = content;
      } else {
        if (count == 2) {
          joined.reserve(bytes.size());
          joined = first;
        }
        joined += content;
      }
    }
    at += 12 + length;
  }
  return {};
}

// Pixels are integers whose lowest byte comes first.
using ByteLanes = std::uint8_t __attribute__((vector_size(16)));
using WordLanes = std::int16_t __attribute__((vector_size(16)));
using WideLanes = std::uint32_t __attribute__((vector_size(16)));

/// Widens four bytes to words.
WordLanes widened(std::uint32_t pixel) {
  const ByteLanes bytes = reinterpret_cast<ByteLanes>(WideLanes{pixel, 0, 0, 0});
  return reinterpret_cast<WordLanes>(
      __builtin_shufflevector(bytes, ByteLanes{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
}
/// Narrows four words to their low bytes.
std::uint32_t narrowed(WordLanes words) {
  const ByteLanes bytes = reinterpret_cast<ByteLanes>(words);
  return reinterpret_cast<WideLanes>(
      __builtin_shufflevector(bytes, bytes, 0, 2, 4, 6, 8, 10, 12, 14, 0, 2, 4, 6, 8, 10, 12, 14))[0];
}
WordLanes greater_lanes(WordLanes a, WordLanes b) { return a > b ? a : b; }
WordLanes lesser_lanes(WordLanes a, WordLanes b) { return a < b ? a : b; }

/// Adds four pairs of bytes, without carries between bytes.
std::uint32_t byte_sums(std::uint32_t a, std::uint32_t b) {
  return ((a & 0x7F7F7F7Fu) + (b & 0x7F7F7F7Fu)) ^ ((a ^ b) & 0x80808080u);
}
std::uint32_t byte_means(std::uint32_t a, std::uint32_t b) { return (a & b) + ((a ^ b) >> 1 & 0x7F7F7F7Fu); }

/// Unfilters a row: reads pixels of `in` bytes, writes pixels of `out` bytes. `to` may overlap `row` if it
/// stays behind the read position.
template <std::size_t in, std::size_t out>
class FilteredRow {
 public:
  FilteredRow(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* to, std::size_t width)
      : row_(row), above_(above), to_(to), width_(width) {}

  /// Returns false for an unknown filter.
  bool decode(std::uint8_t filter) {
    switch (filter) {
      case 0:
        each([](std::uint32_t coded, std::uint32_t, std::uint32_t) { return coded; });
        return true;
      case 1:
        each([](std::uint32_t coded, std::uint32_t left, std::uint32_t) { return byte_sums(coded, left); });
        return true;
      case 2:
        each([](std::uint32_t coded, std::uint32_t, std::uint32_t above) { return byte_sums(coded, above); });
        return true;
      case 3:
        each([](std::uint32_t coded, std::uint32_t left, std::uint32_t above) {
          return byte_sums(coded, byte_means(left, above));
        });
        return true;
      case 4:
        paeth();
        return true;
      default:
        return false;
    }
  }

 private:
  static constexpr std::uint32_t used = in == 1 ? 0xFFu : in == 3 ? 0xFFFFFFu : 0xFFFFFFFFu;

  std::uint32_t coded(std::size_t i) const {
    std::uint32_t pixel;
    std::memcpy(&pixel, row_ + i * in, 4);
    return pixel & used;
  }
  std::uint32_t above(std::size_t i) const {
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, above_ + i * out, out);
    return pixel & used;
  }
  void put(std::size_t i, std::uint32_t pixel) {
    if (in < out) pixel |= 0xFF000000u;
    std::memcpy(to_ + i * out, &pixel, out);
  }

  template <class Decode>
  void each(const Decode& decode) {
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < width_; ++i) {
      left = decode(coded(i), left, above(i)) & used;
      put(i, left);
    }
  }

  /// Predicts whichever of left, above, corner is nearest to left + above - corner; ties go in this order.
  void paeth() {
    WordLanes left{}, corner{};
    for (std::size_t i = 0; i < width_; ++i) {
      const WordLanes up = widened(above(i)), of_left = up - corner, of_up = left - corner;
      const WordLanes both = of_left + of_up;
      const WordLanes a = greater_lanes(of_left, -of_left), b = greater_lanes(of_up, -of_up),
                      c = greater_lanes(both, -both);
      const WordLanes nearest = lesser_lanes(lesser_lanes(a, b), c);
      const WordLanes guess = a == nearest ? left : b == nearest ? up : corner;
      left = (guess + widened(coded(i))) & 0xFF;
      corner = up;
      put(i, narrowed(left));
    }
  }

  const std::uint8_t *row_, *above_;
  std::uint8_t* to_;
  std::size_t width_;
};

template <std::size_t in, std::size_t out>
bool decode_rows(const std::uint8_t* filtered, std::size_t width, std::size_t height, std::uint8_t* to) {
  const std::vector<std::uint8_t> black(width * out);
  const std::uint8_t* above = black.data();
  for (std::size_t y = 0; y < height; ++y, filtered += 1 + width * in, to += width * out) {
    if (!FilteredRow<in, out>(filtered + 1, above, to, width).decode(filtered[0])) return false;
    above = to;
  }
  return true;
}

}  // namespace

bool decode_png_pixels(std::string_view bytes, std::size_t file_channels, StoredImage& image) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  const std::size_t filtered = height * (1 + width * file_channels);
  if (filtered > most_filtered_bytes || std::endian::native != std::endian::little) return false;
  std::string joined;
  const std::string_view packed = packed_pixels(bytes, joined);
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (packed.empty() || !decompressor) return false;
  // The filtered rows lie at the end of the memory that the pixels fill from its start. No pixel is written
  // before it is read, since an output row is at least as long as its filtered row without the filter byte.
  const std::size_t size = image.pixel_count() * image.pixel_bytes();
  fill_large(image.data, size + height + slack);
  std::uint8_t* rows = image.data.data() + size + height - filtered;
  // As no actual size is asked for, the stream must unpack to exactly `filtered` bytes.
  bool whole = libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), rows, filtered,
                                          nullptr) == LIBDEFLATE_SUCCESS;
  if (whole)
    whole = file_channels == 1   ? decode_rows<1, 1>(rows, width, height, image.data.data())
            : file_channels == 3 ? decode_rows<3, 4>(rows, width, height, image.data.data())
                                 : decode_rows<4, 4>(rows, width, height, image.data.data());
  image.data.resize(size);
  return whole;
}

}  // namespace sundog
