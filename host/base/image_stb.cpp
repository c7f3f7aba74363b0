// PNG, JPEG and the writing of Radiance HDR through the stb libraries, whose code is compiled here and
// nowhere else.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "base/image_codecs.h"

#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_HDR
#define STBI_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
// Deflates through zlib: in half the time, and to a fifth less, of what stb_image_write's own does.
static unsigned char* zlib_compress(unsigned char* data, int size, int* compressed_size, int) {
  uLongf room = compressBound(static_cast<uLong>(size));
  auto* compressed = static_cast<unsigned char*>(std::malloc(room));  // stb frees it
  if (!compressed) return nullptr;
  if (compress2(compressed, &room, data, static_cast<uLong>(size), 4) != Z_OK) {
    std::free(compressed);
    return nullptr;
  }
  *compressed_size = static_cast<int>(room);
  return compressed;
}
#define STBIW_ZLIB_COMPRESS zlib_compress
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace sundog {
namespace {

template <class T>
using Pixels = std::unique_ptr<T, decltype(&stbi_image_free)>;

int int_size(std::string_view bytes) {
  if (bytes.size() > INT_MAX) throw std::runtime_error("the file is larger than 2 GiB");
  return static_cast<int>(bytes.size());
}

const stbi_uc* data(std::string_view bytes) { return reinterpret_cast<const stbi_uc*>(bytes.data()); }

[[noreturn]] void fail_to_decode() {
  const char* reason = stbi_failure_reason();
  throw std::runtime_error(std::string("wanted a PNG, JPEG, EXR, HDR or PFM image, found a bad one: ") +
                           (reason ? reason : "no reason known"));
}

void append(void* context, void* bytes, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

std::uint8_t byte_from_unit(float value) {  // NaN becomes 0
  return static_cast<std::uint8_t>(std::lround(255 * (value > 0 ? std::min(value, 1.0f) : 0.0f)));
}

std::vector<std::uint8_t> srgb_samples(const Image& image) {
  std::vector<std::uint8_t> samples(image.data.size());
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool alpha = channels == 4 && i % channels == 3;
    samples[i] = byte_from_unit(alpha ? image.data[i] : srgb_from_linear(image.data[i]));
  }
  return samples;
}

/// The linear value of each of `count` sample values.
std::vector<float> decoding_table(std::size_t count, std::optional<float> exponent) {
  std::vector<float> table(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float encoded = static_cast<float>(i) / static_cast<float>(count - 1);
    table[i] = exponent ? std::pow(encoded, *exponent) : linear_from_srgb(encoded);
  }
  return table;
}

template <class Sample>
Image linear_image(const Sample* samples, int width, int height, std::optional<float> exponent) {
  constexpr float top = std::numeric_limits<Sample>::max();
  const std::vector<float> table = decoding_table(static_cast<std::size_t>(top) + 1, exponent);
  Image image(width, height, 4);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = i % 4 == 3 ? static_cast<float>(samples[i]) / top : table[samples[i]];
  return image;
}

std::uint32_t big_endian(std::string_view four) {
  std::uint32_t value = 0;
  for (const char c : four) value = value << 8 | static_cast<unsigned char>(c);
  return value;
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
      // 0.45455 is what writers say who mean sRGB.
      if (gamma > 0 && (gamma < 45000 || gamma > 46000)) exponent = 1e5f / static_cast<float>(gamma);
    }
    at += 12 + length;
  }
  return exponent;
}

std::string encode_png(const Image& image) {
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  if ((row + 1) * static_cast<std::size_t>(image.height) > INT_MAX / 2)
    throw std::runtime_error("the image is too large for a PNG; use .exr");
  const std::vector<std::uint8_t> samples = srgb_samples(image);
  std::string bytes;
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, image.channels, samples.data(),
                              static_cast<int>(row)))
    throw std::runtime_error("the PNG encoder failed");
  return bytes;
}

std::string encode_jpeg(const Image& image) {
  constexpr int greatest_side = 65535;
  // From 91 on stb_image_write keeps the colours of each pixel, not of four at once.
  constexpr int quality = 92;
  if (std::max(image.width, image.height) > greatest_side)
    throw std::runtime_error("the image is too large for a JPEG; use .png or .exr");
  const std::vector<std::uint8_t> samples = srgb_samples(image);
  std::string bytes;
  if (!stbi_write_jpg_to_func(append, &bytes, image.width, image.height, image.channels, samples.data(),
                              quality))
    throw std::runtime_error("the JPEG encoder failed");
  return bytes;
}

Image decode_png_or_jpeg(std::string_view bytes) {
  const std::optional<float> exponent = png_decoding_exponent(bytes);
  if (bytes.starts_with("\xff\xd8") && bytes.rfind("\xff\xd9") == std::string_view::npos)
    throw std::runtime_error("the JPEG data is cut short");  // stb would make up the rest
  int width = 0, height = 0, channels = 0;
  if (stbi_is_16_bit_from_memory(data(bytes), int_size(bytes))) {
    const Pixels<stbi_us> samples(
        stbi_load_16_from_memory(data(bytes), int_size(bytes), &width, &height, &channels, 4),
        stbi_image_free);
    if (!samples) fail_to_decode();
    return linear_image(samples.get(), width, height, exponent);
  }
  const Pixels<stbi_uc> samples(
      stbi_load_from_memory(data(bytes), int_size(bytes), &width, &height, &channels, 4), stbi_image_free);
  if (!samples) fail_to_decode();
  return linear_image(samples.get(), width, height, exponent);
}

std::string encode_hdr(const Image& image) {
  constexpr float greatest = 1e38f;  // what RGBE's exponent reaches
  std::vector<float> colors;
  colors.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float value = image.pixel(x, y)[c];
        colors.push_back(value > 0 ? std::min(value, greatest) : 0.0f);  // NaN becomes 0
      }
  std::string bytes;
  if (!stbi_write_hdr_to_func(append, &bytes, image.width, image.height, 3, colors.data()))
    throw std::runtime_error("the HDR encoder failed");
  return bytes;
}

}  // namespace sundog
