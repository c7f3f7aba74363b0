// Decodes PNG with libspng, under limits set before decoding; the most common files with png_pixels.h.
#include <fmt/format.h>
#include <spng.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "base/image_codecs.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/pixels/png_pixels.h"
#include "base/pixels/stored_image.h"

namespace sundog {
namespace {

using Context = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

/// Deflate packs at most 1032 bytes into one, and a byte holds at most eight pixels.
constexpr std::int64_t png_pixels_a_byte = std::int64_t{1032} * 8;
/// Texts and profiles are ignored.
constexpr std::size_t most_chunk_bytes = std::size_t{1} << 26;

void check_png(int error) {
  if (error)
    throw std::runtime_error(fmt::format(
        "wanted a PNG, JPEG, WebP, EXR, HDR or PFM image, found a bad PNG: {}", spng_strerror(error)));
}

std::uint32_t big_endian(std::string_view four) {
  std::uint32_t value = 0;
  for (const char c : four) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

/// The output format; grey stays grey unless something is transparent.
spng_format format_of(const spng_ihdr& header, bool transparent, StoredImage& stored) {
  const bool grey = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE && !transparent;
  stored.channels = grey ? 1 : 4;
  stored.sample = header.bit_depth == 16 ? StoredImage::Sample::word : StoredImage::Sample::byte;
  if (grey) return header.bit_depth == 16 ? SPNG_FMT_PNG : SPNG_FMT_G8;  // words in the machine's order
  return header.bit_depth == 16 ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8;
}

/// Channels of a file that png_pixels.h can decode; 0 for others.
std::size_t plain_channels(const spng_ihdr& header, bool transparent) {
  if (header.bit_depth != 8 || header.interlace_method != SPNG_INTERLACE_NONE || transparent) return 0;
  switch (header.color_type) {
    case SPNG_COLOR_TYPE_GRAYSCALE:
      return 1;
    case SPNG_COLOR_TYPE_TRUECOLOR:
      return 3;
    case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

std::optional<float> png_decoding_exponent(std::string_view bytes) {
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n")) return {};
  std::optional<float> exponent;
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::string_view type = bytes.substr(at + 4, 4);
    if (type == "sRGB" || type == "iCCP") return {};
    if (type == "IDAT") break;
    const std::size_t length = big_endian(bytes.substr(at, 4));
    if (type == "gAMA" && length == 4) {
      const std::uint32_t gamma = big_endian(bytes.substr(at + 8, 4));  // 100000 times the encoding exponent
      // Writers of sRGB files state 0.45455.
      if (gamma > 0 && (gamma < 45000 || gamma > 46000)) exponent = 1e5f / static_cast<float>(gamma);
    }
    at += 12 + length;
  }
  return exponent;
}

StoredImage decode_png(std::string_view bytes) {
  const Context context(spng_ctx_new(0), spng_ctx_free);
  if (!context) throw std::bad_alloc();
  check_png(spng_set_image_limits(context.get(), most_edge, most_edge));
  check_png(spng_set_chunk_limits(context.get(), most_chunk_bytes, 4 * most_chunk_bytes));
  check_png(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()));
  spng_ihdr header{};
  check_png(spng_get_ihdr(context.get(), &header));
  StoredImage stored;
  stored.width = static_cast<int>(header.width);
  stored.height = static_cast<int>(header.height);
  check_image_size(header.width, header.height, 8, bytes.size(), png_pixels_a_byte);
  spng_trns ignored{};
  const int transparency = spng_get_trns(context.get(), &ignored);
  if (transparency != SPNG_ECHUNKAVAIL) check_png(transparency);
  const int format = format_of(header, transparency == 0, stored);
  stored.exponent = png_decoding_exponent(bytes);
  const std::size_t plain = plain_channels(header, transparency == 0);
  if (plain && decode_png_pixels(bytes, plain, stored)) return stored;
  std::size_t size = 0;
  check_png(spng_decoded_image_size(context.get(), format, &size));
  stored.data.clear();
  fill_large(stored.data, size);
  check_png(spng_decode_image(context.get(), stored.data.data(), size, format, SPNG_DECODE_TRNS));
  return stored;
}

std::string encode_png(const StoredImage& image) {
  const Context context(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
  if (!context) throw std::bad_alloc();
  const auto check = [](int error) {
    if (error) throw std::runtime_error(fmt::format("PNG: {}", spng_strerror(error)));
  };
  std::vector<std::uint8_t> samples;
  const std::size_t bytes = image.sample_bytes();
  if (image.channels == 1) {
    samples = image.data;
  } else {
    samples.reserve(image.data.size() / 4 * 3);
    for (std::size_t i = 0; i < image.data.size(); i += 4 * bytes)
      samples.insert(samples.end(), image.data.begin() + static_cast<std::ptrdiff_t>(i),
                     image.data.begin() + static_cast<std::ptrdiff_t>(i + 3 * bytes));
  }
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(image.width);
  header.height = static_cast<std::uint32_t>(image.height);
  header.bit_depth = static_cast<std::uint8_t>(8 * bytes);
  header.color_type =
      static_cast<std::uint8_t>(image.channels == 1 ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_TRUECOLOR);
  check(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1));
  check(spng_set_ihdr(context.get(), &header));
  check(spng_encode_image(context.get(), samples.data(), samples.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE));
  std::size_t size = 0;
  int error = 0;
  const std::unique_ptr<void, decltype(&std::free)> png(spng_get_png_buffer(context.get(), &size, &error),
                                                        std::free);
  check(error);
  return std::string(static_cast<const char*>(png.get()), size);
}

}  // namespace sundog
