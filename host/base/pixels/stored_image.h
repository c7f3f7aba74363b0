// StoredImage: an image file's pixels at the file's precision, for textures. Each format is decoded by its
// own library, under limits set before decoding.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.h"

namespace sundog {

/// Rows from the top, interleaved samples, words and halves in native byte order. Colours are sRGB unless
/// `exponent` makes them linear; halves and alpha are linear.
struct StoredImage {
  enum class Sample { byte, word, half };
  int width = 0, height = 0;
  int channels = 4;  // 1: grey, 4: RGBA
  Sample sample = Sample::byte;
  std::optional<float> exponent;
  std::vector<std::uint8_t> data;

  std::size_t sample_bytes() const { return sample == Sample::byte ? 1 : 2; }
  std::size_t pixel_bytes() const { return sample_bytes() * static_cast<std::size_t>(channels); }
  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Decodes PNG, JPEG, WebP, BMP, TGA, Radiance HDR, EXR and PFM, recognised by content; samples of the last
/// three become halves. `colors`: an EXR is converted to sRGB primaries. Throws std::runtime_error with the
/// reason, without a file name.
StoredImage decode_stored(std::string_view bytes, bool colors = true);

/// Encodes as grey or RGB PNG of 8 or 16 bits, without alpha. Throws std::runtime_error.
std::string encode_png(const StoredImage& image);

/// Each decodes one format. A PNG's gAMA chunk sets the exponent, unless gAMA means sRGB or the file has an
/// sRGB or iCCP chunk. Animated WebP is refused.
StoredImage decode_png(std::string_view bytes);
StoredImage decode_jpeg(std::string_view bytes);
StoredImage decode_webp(std::string_view bytes);
StoredImage decode_bmp_or_tga(std::string_view bytes);
/// The file's number of channels; 0 for other files.
int channels_of_bmp_or_tga(std::string_view bytes);

/// Throws for sizes that no frame may have, for more pixels than `file_bytes` can encode, and for images that
/// need more than half of the available memory.
void check_image_size(std::int64_t width, std::int64_t height, std::size_t pixel_bytes,
                      std::size_t file_bytes, std::int64_t most_pixels_a_byte);

/// Converts to linear RGBA.
Image linear_image(const StoredImage& stored);

/// The nearest half of a float, clamped to +-65504 (NaN becomes 0), and the inverse.
std::uint16_t half_from_float(float value);
float float_from_half(std::uint16_t bits);

}  // namespace sundog
