// Writes JPEG and Radiance HDR with stb_image_write, whose code is compiled only here.
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "base/pixels/image_codecs.h"
#include "base/pixels/quick_png.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace sundog {
namespace {

void append(void* context, void* bytes, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

}  // namespace

std::string encode_jpeg(const Image& image, const FileOptions& options) {
  // Above 90, stb_image_write stores the colour of each pixel, not one for four pixels.
  constexpr int quality = 92;
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<std::uint8_t> samples;
  samples.reserve(3 * (image.data.size() / channels));
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % channels < 3) samples.push_back(srgb_byte(image.data[i]));
  std::string bytes;
  if (!stbi_write_jpg_to_func(append, &bytes, image.width, image.height, 3, samples.data(), quality))
    throw std::runtime_error("the JPEG encoder failed");
  return with_jpeg_tags(std::move(bytes), options);
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
