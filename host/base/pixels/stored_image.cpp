// Picks the decoder by a file's first bytes, and converts stored samples to linear values.
#include "base/pixels/stored_image.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "base/limits.h"
#include "base/memory.h"
#include "base/pixels/image_codecs.h"

namespace sundog {
namespace {

StoredImage stored_halves(const Image& image) {
  StoredImage stored;
  stored.width = image.width;
  stored.height = image.height;
  stored.sample = StoredImage::Sample::half;
  stored.data.resize(image.data.size() * 2);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const std::uint16_t bits = half_from_float(image.data[i]);
    std::memcpy(stored.data.data() + 2 * i, &bits, 2);
  }
  return stored;
}

/// Linear values of all `count` sample values.
std::vector<float> decoding_table(std::size_t count, std::optional<float> exponent) {
  std::vector<float> table(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float encoded = static_cast<float>(i) / static_cast<float>(count - 1);
    table[i] = exponent ? std::pow(encoded, *exponent) : linear_from_srgb(encoded);
  }
  return table;
}

}  // namespace

void check_image_size(std::int64_t width, std::int64_t height, std::size_t pixel_bytes,
                      std::size_t file_bytes, std::int64_t most_pixels_a_byte) {
  if (!is_frame_size(width, height))
    throw std::runtime_error(
        fmt::format("the image says {}x{} pixels; edges up to {} and {} pixels in all are read", width,
                    height, most_edge, most_pixels));
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (pixels / static_cast<std::uint64_t>(most_pixels_a_byte) > file_bytes)
    throw std::runtime_error(fmt::format("the image is cut short: it says {}x{} pixels and has {} bytes",
                                         width, height, file_bytes));
  const auto there = available_memory();
  if (there && pixels * pixel_bytes > *there / 2)
    throw std::runtime_error(
        fmt::format("the image of {}x{} pixels takes {} MiB, more than half of the memory that is available",
                    width, height, pixels * pixel_bytes >> 20));
}

StoredImage decode_stored(std::string_view bytes, bool colors) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(bytes);
  if (bytes.starts_with("\xff\xd8")) return decode_jpeg(bytes);
  if (bytes.starts_with("RIFF")) return decode_webp(bytes);
  if (bytes.starts_with("\x76\x2f\x31\x01")) return stored_halves(decode_exr(bytes, colors));
  if (bytes.starts_with("#?")) return stored_halves(decode_hdr(bytes));
  if (bytes.starts_with("PF") || bytes.starts_with("Pf")) return stored_halves(decode_pfm(bytes));
  if (channels_of_bmp_or_tga(bytes) > 0) return decode_bmp_or_tga(bytes);
  throw std::runtime_error("wanted a PNG, JPEG, WebP, BMP, TGA, EXR, HDR or PFM image, found another file");
}

Image linear_image(const StoredImage& stored) {
  Image image(stored.width, stored.height, 4);
  const bool bytes = stored.sample == StoredImage::Sample::byte;
  if (stored.sample == StoredImage::Sample::half)
    throw std::logic_error("linear_image() takes bytes and words");
  const std::vector<float> table = decoding_table(bytes ? 256 : 65536, stored.exponent);
  const float top = bytes ? 255 : 65535;
  const auto sample = [&](std::size_t i) -> std::size_t {
    if (bytes) return stored.data[i];
    std::uint16_t word;
    std::memcpy(&word, stored.data.data() + 2 * i, 2);
    return word;
  };
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const std::size_t channel = i % 4;
    if (stored.channels == 1)
      image.data[i] = channel == 3 ? 1 : table[sample(i / 4)];
    else
      image.data[i] = channel == 3 ? static_cast<float>(sample(i)) / top : table[sample(i)];
  }
  return image;
}

std::uint16_t half_from_float(float value) {
  if (!(value == value)) return 0;
  return half(std::clamp(value, -65504.0f, 65504.0f)).bits();
}

float float_from_half(std::uint16_t bits) {
  half value;
  value.setBits(bits);
  return value;
}

}  // namespace sundog
