#include "base/pixels/image_levels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/image_io.h"

namespace sundog {
namespace {

using Sample = StoredImage::Sample;

/// A level in linear floats; colours times alpha where they count by it.
struct LinearLevel {
  int width = 0, height = 0;
  std::size_t channels = 4;
  std::vector<float> data;
};

const std::array<float, 256>& linear_bytes() {
  static const auto table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < 256; ++i) values[i] = linear_from_srgb(static_cast<float>(i) / 255);
    return values;
  }();
  return table;
}

/// Bytes by linear values, at steps so fine that the nearest one is right to a quarter of a byte.
constexpr std::size_t srgb_steps = std::size_t{1} << 14;
const std::vector<std::uint8_t>& srgb_bytes() {
  static const auto table = [] {
    std::vector<std::uint8_t> values(srgb_steps + 1);
    for (std::size_t i = 0; i <= srgb_steps; ++i)
      values[i] = static_cast<std::uint8_t>(
          std::lround(255 * srgb_from_linear(static_cast<float>(i) / static_cast<float>(srgb_steps))));
    return values;
  }();
  return table;
}

std::uint16_t word_at(const StoredImage& image, std::size_t sample) {
  std::uint16_t word;
  std::memcpy(&word, image.data.data() + 2 * sample, 2);
  return word;
}

/// Samples of an image as linear floats.
class SampleReader {
 public:
  SampleReader(const StoredImage& image, bool srgb) : image_(image), srgb_(srgb) {
    for (std::size_t i = 0; i < 256; ++i) table_[i] = srgb ? linear_bytes()[i] : static_cast<float>(i) / 255;
  }
  /// A pixel's channels; colours times alpha where `by_alpha`.
  void pixel(std::size_t at, float* to) const {
    const auto channels = static_cast<std::size_t>(image_.channels);
    if (image_.sample == Sample::byte) {
      const std::uint8_t* from = image_.data.data() + at * channels;
      to[0] = table_[from[0]];
      if (channels == 1) return;
      to[1] = table_[from[1]];
      to[2] = table_[from[2]];
      to[3] = static_cast<float>(from[3]) / 255;
    } else {
      for (std::size_t c = 0; c < channels; ++c) {
        const std::uint16_t word = word_at(image_, at * channels + c);
        to[c] = image_.sample == Sample::word ? static_cast<float>(word) / 65535 : float_from_half(word);
      }
    }
    if (srgb_ && channels == 4)
      for (int c = 0; c < 3; ++c) to[c] *= to[3];
  }

 private:
  const StoredImage& image_;
  bool srgb_;
  std::array<float, 256> table_{};
};

/// Which pixels of an edge make pixel `i` of the half edge, from 2 i on, and their weights.
std::array<float, 3> weights_of(int edge, int i) {
  if (edge == 1) return {1, 0, 0};
  if (edge % 2 == 0) return {0.5f, 0.5f, 0};
  const auto n = static_cast<float>(edge);
  const int half = edge / 2;
  return {static_cast<float>(half - i) / n, static_cast<float>(half) / n, static_cast<float>(i + 1) / n};
}

template <class Pixel>
LinearLevel halve(int width, int height, std::size_t channels, const Pixel& pixel) {
  LinearLevel level{std::max(1, width / 2), std::max(1, height / 2), channels, {}};
  level.data.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) *
                    channels);
  tbb::parallel_for(tbb::blocked_range<int>(0, level.height, 16), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) {
      const auto down = weights_of(height, y);
      float* to =
          level.data.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) * channels;
      for (int x = 0; x < level.width; ++x, to += channels) {
        const auto across = weights_of(width, x);
        float sum[4] = {}, value[4] = {};
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i) {
            const float weight = down[static_cast<std::size_t>(j)] * across[static_cast<std::size_t>(i)];
            if (weight == 0) continue;
            pixel(static_cast<std::size_t>(2 * y + j) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(2 * x + i),
                  value);
            for (std::size_t c = 0; c < channels; ++c) sum[c] += weight * value[c];
          }
        std::copy(sum, sum + channels, to);
      }
    }
  });
  return level;
}

LinearLevel halve(const LinearLevel& from) {
  return halve(from.width, from.height, from.channels, [&](std::size_t at, float* to) {
    std::copy_n(from.data.data() + at * from.channels, from.channels, to);
  });
}

LinearLevel halve(const StoredImage& from, bool srgb) {
  const SampleReader reader(from, srgb);
  return halve(from.width, from.height, static_cast<std::size_t>(from.channels),
               [&](std::size_t at, float* to) { reader.pixel(at, to); });
}

void write_sample(StoredImage& image, std::size_t sample, float value, bool srgb) {
  if (image.sample == Sample::byte) {
    const float unit = std::clamp(value, 0.0f, 1.0f);
    image.data[sample] =
        srgb ? srgb_bytes()[static_cast<std::size_t>(unit * static_cast<float>(srgb_steps) + 0.5f)]
             : static_cast<std::uint8_t>(unit * 255 + 0.5f);
    return;
  }
  const std::uint16_t word = image.sample == Sample::half
                                 ? half_from_float(value)
                                 : static_cast<std::uint16_t>(std::clamp(value, 0.0f, 1.0f) * 65535 + 0.5f);
  std::memcpy(image.data.data() + 2 * sample, &word, 2);
}

StoredImage store(const LinearLevel& level, Sample kind, bool srgb) {
  StoredImage image;
  image.width = level.width;
  image.height = level.height;
  image.channels = static_cast<int>(level.channels);
  image.sample = kind;
  image.data.resize(image.pixel_count() * image.pixel_bytes());
  const bool by_alpha = srgb && level.channels == 4;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.pixel_count(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const float* from = level.data.data() + i * level.channels;
      const float alpha = by_alpha ? from[3] : 1, scale = alpha > 0 ? 1 / alpha : 0;
      for (std::size_t c = 0; c < level.channels; ++c)
        write_sample(image, i * level.channels + c, c == 3 ? from[3] : from[c] * scale, srgb && c != 3);
    }
  });
  return image;
}

}  // namespace

void settle_samples(StoredImage& image, bool srgb) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const auto linear = [&](float encoded) {
    return image.exponent ? std::pow(encoded, *image.exponent) : linear_from_srgb(encoded);
  };
  if (image.sample == Sample::byte && srgb && image.exponent) {
    std::array<std::uint8_t, 256> table{};
    for (std::size_t i = 0; i < 256; ++i)
      table[i] =
          static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(linear(static_cast<float>(i) / 255))));
    for (std::size_t i = 0; i < image.data.size(); ++i)
      if (channels == 1 || i % channels != 3) image.data[i] = table[image.data[i]];
  }
  if (image.sample == Sample::word && srgb) {
    std::vector<std::uint16_t> halves(65536);
    for (std::size_t i = 0; i < halves.size(); ++i)
      halves[i] = half_from_float(linear(static_cast<float>(i) / 65535));
    for (std::size_t i = 0; i < image.data.size() / 2; ++i) {
      const std::uint16_t word = word_at(image, i);
      const bool alpha = channels == 4 && i % 4 == 3;
      const std::uint16_t bits = alpha ? half_from_float(static_cast<float>(word) / 65535) : halves[word];
      std::memcpy(image.data.data() + 2 * i, &bits, 2);
    }
    image.sample = Sample::half;
  }
  image.exponent.reset();
}

std::vector<StoredImage> smaller_levels(const StoredImage& image, bool srgb) {
  std::vector<StoredImage> levels;
  if (image.width == 1 && image.height == 1) return levels;
  LinearLevel level = halve(image, srgb);
  levels.push_back(store(level, image.sample, srgb));
  while (level.width > 1 || level.height > 1) {
    level = halve(level);
    levels.push_back(store(level, image.sample, srgb));
  }
  return levels;
}

StoredImage half_size(const StoredImage& image, bool srgb) {
  return store(halve(image, srgb), image.sample, srgb);
}

}  // namespace sundog
