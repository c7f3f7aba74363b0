// Encodes and decodes PNG with libspng, under limits; png_pixels.h decodes the most common files.
#include <fmt/format.h>
#include <spng.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "base/colors/icc_profile.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/pixels/image_codecs.h"
#include "base/pixels/png_pixels.h"
#include "base/pixels/quick_png.h"
#include "base/pixels/stored_image.h"

namespace sundog {
namespace {

using Context = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

/// Deflate packs at most 1032 bytes into one, and a byte holds at most eight pixels.
constexpr std::int64_t png_pixels_a_byte = std::int64_t{1032} * 8;
constexpr std::size_t most_chunk_bytes = std::size_t{1} << 26;

void check_png(int error) {
  if (error) throw std::runtime_error(fmt::format("a bad PNG image: {}", spng_strerror(error)));
}

/// A decoder for `bytes`, which must outlive it.
Context decoder_of(std::string_view bytes) {
  Context context(spng_ctx_new(0), spng_ctx_free);
  if (!context) throw std::bad_alloc();
  check_png(spng_set_image_limits(context.get(), most_edge, most_edge));
  check_png(spng_set_chunk_limits(context.get(), most_chunk_bytes, 4 * most_chunk_bytes));
  check_png(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()));
  return context;
}

/// The exponent that makes a PNG's samples linear; none: sRGB.
std::optional<float> decoding_exponent(spng_ctx* context) {
  std::uint8_t intent = 0;
  spng_iccp profile{};
  std::uint32_t gamma = 0;  // 100000 times the encoding exponent
  if (!spng_get_srgb(context, &intent) || !spng_get_iccp(context, &profile)) return {};
  // Programs that write sRGB files state 0.45455.
  if (spng_get_gama_int(context, &gamma) || gamma == 0 || (gamma >= 45000 && gamma <= 46000)) return {};
  return 1e5f / static_cast<float>(gamma);
}

/// The output format: grey for a grey file without transparency, else RGBA.
spng_format format_of(const spng_ihdr& header, bool transparent, StoredImage& stored) {
  const bool grey = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE && !transparent;
  stored.channels = grey ? 1 : 4;
  stored.sample = header.bit_depth == 16 ? StoredImage::Sample::word : StoredImage::Sample::byte;
  if (grey) return header.bit_depth == 16 ? SPNG_FMT_PNG : SPNG_FMT_G8;  // words in native byte order
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

template <class Pixels>
spng_ihdr header_of(const Pixels& image, int channels, int bits) {
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(image.width);
  header.height = static_cast<std::uint32_t>(image.height);
  header.bit_depth = static_cast<std::uint8_t>(bits);
  header.color_type = channels == 1   ? SPNG_COLOR_TYPE_GRAYSCALE
                      : channels == 3 ? SPNG_COLOR_TYPE_TRUECOLOR
                                      : SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
  return header;
}

void check_encoder(int error) {
  if (error && error != SPNG_EOI) throw std::runtime_error(fmt::format("PNG: {}", spng_strerror(error)));
}

/// Adds an sRGB chunk, sRGB's gamma and primaries for programs that ignore this chunk (PNG, third edition,
/// 11.3.2.5), and the density. With a profile, which must live until the image is encoded, an iCCP chunk
/// replaces the sRGB chunk.
void tag_as_srgb(spng_ctx* context, int dpi, std::string& profile) {
  spng_chrm_int primaries{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
  spng_iccp chunk{"sRGB", profile.size(), profile.data()};
  check_encoder(profile.empty() ? spng_set_srgb(context, 0) : spng_set_iccp(context, &chunk));
  check_encoder(spng_set_gama_int(context, 45455));
  check_encoder(spng_set_chrm_int(context, &primaries));
  const auto pixels_a_metre = static_cast<std::uint32_t>(std::lround(dpi / 0.0254));
  spng_phys density{pixels_a_metre, pixels_a_metre, 1};
  check_encoder(spng_set_phys(context, &density));
}

/// `texts` must live until the image is encoded.
void add_texts(spng_ctx* context, const ImageTexts& texts) {
  static constexpr char none[] = "";  // neither a language nor a translation
  std::vector<spng_text> chunks;
  for (const auto& [keyword, text] : texts) {
    spng_text chunk{.keyword = "",
                    .type = SPNG_ITXT,
                    .length = text.size(),
                    .text = const_cast<char*>(text.data()),  // libspng only reads it
                    .compression_flag = 0,
                    .compression_method = 0,
                    .language_tag = const_cast<char*>(none),
                    .translated_keyword = const_cast<char*>(none)};
    keyword.copy(chunk.keyword, sizeof chunk.keyword - 1);
    chunks.push_back(chunk);
  }
  if (!chunks.empty())
    check_encoder(spng_set_text(context, chunks.data(), static_cast<std::uint32_t>(chunks.size())));
}

int append_bytes(spng_ctx*, void* to, void* bytes, std::size_t size) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), size);
  return 0;
}

/// `fill(y, row)` writes a row's samples, words in native byte order. With `file`, tags the colours as sRGB.
template <class Fill>
std::string encode_rows(spng_ihdr header, std::size_t row_bytes, const FileOptions* file, const Fill& fill) {
  constexpr int level = 4;  // zlib's: half the time of its default, hardly larger files
  constexpr int filters = SPNG_FILTER_CHOICE_SUB | SPNG_FILTER_CHOICE_UP;  // a fifth less time, same size
  std::string profile = file && file->icc ? srgb_icc_profile() : "";       // outlives the context
  const Context context(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
  if (!context) throw std::bad_alloc();
  std::vector<std::uint8_t> row(row_bytes);
  std::string bytes;
  bytes.reserve(row.size() * header.height + row.size() * header.height / 1000 + 65536);  // never grows
  check_encoder(spng_set_png_stream(context.get(), append_bytes, &bytes));
  check_encoder(spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, level));
  check_encoder(spng_set_option(context.get(), SPNG_FILTER_CHOICE, filters));
  check_encoder(spng_set_ihdr(context.get(), &header));
  if (file) tag_as_srgb(context.get(), file->dpi, profile);
  if (file) add_texts(context.get(), file->texts);
  check_encoder(spng_encode_image(context.get(), nullptr, 0, SPNG_FMT_PNG,
                                  SPNG_ENCODE_PROGRESSIVE | SPNG_ENCODE_FINALIZE));
  for (std::size_t y = 0; y < header.height; ++y) {
    fill(y, row.data());
    check_encoder(spng_encode_row(context.get(), row.data(), row.size()));
  }
  return bytes;
}

/// NaN becomes 0.
std::uint16_t rounded(float value, float most) {
  return static_cast<std::uint16_t>(std::lround(most * (value > 0 ? std::min(value, 1.0f) : 0.0f)));
}

void put_word(std::uint8_t* to, std::uint16_t word) { std::memcpy(to, &word, sizeof word); }

}  // namespace

ImageTexts decode_png_texts(std::string_view bytes) {
  const Context context = decoder_of(bytes);
  std::uint32_t count = 0;
  if (spng_get_text(context.get(), nullptr, &count)) return {};  // none, or no PNG
  std::vector<spng_text> chunks(count);
  check_png(spng_get_text(context.get(), chunks.data(), &count));
  ImageTexts texts;
  for (const spng_text& chunk : chunks)
    if (chunk.type == SPNG_ITXT) texts.emplace_back(chunk.keyword, std::string(chunk.text, chunk.length));
  return texts;
}

StoredImage decode_png(std::string_view bytes) {
  const Context context = decoder_of(bytes);
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
  stored.exponent = decoding_exponent(context.get());
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
  const std::size_t bytes = image.sample_bytes(), columns = static_cast<std::size_t>(image.width);
  const auto from = static_cast<std::size_t>(image.channels), to = std::min<std::size_t>(from, 3);
  return encode_rows(header_of(image, static_cast<int>(to), static_cast<int>(8 * bytes)),
                     to * columns * bytes, nullptr, [&](std::size_t y, std::uint8_t* row) {
                       for (std::size_t x = 0; x < columns; ++x)
                         row = std::copy_n(&image.data[(y * columns + x) * from * bytes], to * bytes, row);
                     });
}

std::string encode_png(const Image& image, const FileOptions& options) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t samples = channels * static_cast<std::size_t>(image.width);
  return encode_rows(
      header_of(image, image.channels, options.bits), samples * static_cast<std::size_t>(options.bits) / 8,
      &options, [&](std::size_t y, std::uint8_t* row) {
        const float* from = &image.data[y * samples];
        for (std::size_t i = 0; i < samples; ++i) {
          const bool alpha = i % channels == 3;
          if (options.bits == 8)
            row[i] = alpha ? static_cast<std::uint8_t>(rounded(from[i], 255)) : srgb_byte(from[i]);
          else
            put_word(row + 2 * i, rounded(alpha ? from[i] : srgb_from_linear(from[i]), 65535));
        }
      });
}

}  // namespace sundog
