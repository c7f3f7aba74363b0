// The writing of PNG, JPEG and Radiance HDR through stb_image_write, whose code is compiled here and nowhere
// else.
#include <zlib.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "base/image_codecs.h"

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

}  // namespace

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

std::string encode_hdr(const Image& image) {
  constexpr float greatest = 1e38f;  // limit of RGBE's exponent
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
