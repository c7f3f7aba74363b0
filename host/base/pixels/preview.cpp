// Converts to sRGB with a table of 4096 levels and encodes with libjpeg-turbo, in 4:4:4 from quality 90 on.
#include "base/pixels/preview.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "base/image_io.h"

namespace sundog {
namespace {

constexpr std::size_t levels = 4096;

std::array<std::uint8_t, levels> srgb_table() {
  std::array<std::uint8_t, levels> table{};
  for (std::size_t i = 0; i < levels; ++i)
    table[i] =
        static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(static_cast<float>(i) / (levels - 1))));
  return table;
}

std::vector<std::uint8_t> screen_samples(const Image& image) {
  static const auto table = srgb_table();
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t pixels = image.data.size() / channels;
  std::vector<std::uint8_t> samples(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = image.data[i * channels + c];
      const float clipped = value > 0 ? std::min(value, 1.0f) : 0.0f;  // NaN becomes 0
      samples[3 * i + c] = table[static_cast<std::size_t>(std::lround(clipped * (levels - 1)))];
    }
  return samples;
}

struct DestroyEncoder {
  void operator()(void* handle) const { tjDestroy(handle); }
};

}  // namespace

std::string encode_preview(const Image& image, int quality) {
  const std::unique_ptr<void, DestroyEncoder> handle(tjInitCompress());
  if (!handle) throw std::bad_alloc();
  const std::vector<std::uint8_t> samples = screen_samples(image);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(handle.get(), samples.data(), image.width, 0, image.height, TJPF_RGB, &bytes,
                                 &size, quality >= 90 ? TJSAMP_444 : TJSAMP_420, quality, TJFLAG_FASTDCT);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(bytes, &tjFree);
  if (failed)
    throw std::runtime_error(std::string("the JPEG encoder failed: ") + tjGetErrorStr2(handle.get()));
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace sundog
