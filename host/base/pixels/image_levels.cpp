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

/// One pixel's channels, linear; colours times alpha where they count by it.
template <std::size_t channels>
using Pixel = std::array<float, channels>;

template <std::size_t channels>
Pixel<channels> mean_of_pixels(const Pixel<channels>& a, const Pixel<channels>& b, const Pixel<channels>& c,
                               const Pixel<channels>& d) {
  Pixel<channels> mean;
  for (std::size_t k = 0; k < channels; ++k) mean[k] = 0.25f * (a[k] + b[k] + c[k] + d[k]);
  return mean;
}

/// Pixels of a level.
template <std::size_t channels>
class LevelReader {
 public:
  explicit LevelReader(const LinearLevel& level) : data_(level.data.data()) {}
  Pixel<channels> operator()(std::size_t at) const {
    Pixel<channels> pixel;
    std::copy_n(data_ + at * channels, channels, pixel.begin());
    return pixel;
  }
  /// The mean of 2x2 pixels from `at` on.
  Pixel<channels> mean_of_four(std::size_t at, std::size_t width) const {
    const LevelReader& read = *this;
    return mean_of_pixels<channels>(read(at), read(at + 1), read(at + width), read(at + width + 1));
  }

 private:
  const float* data_;
};

/// Samples of an image as linear floats.
template <std::size_t channels>
class SampleReader {
 public:
  SampleReader(const StoredImage& image, bool srgb) : image_(image), by_alpha_(srgb && channels == 4) {
    for (std::size_t i = 0; i < 256; ++i) {
      plain_[i] = static_cast<float>(i) / 255;
      table_[i] = srgb ? linear_bytes()[i] : plain_[i];
    }
  }
  Pixel<channels> operator()(std::size_t at) const {
    Pixel<channels> pixel;
    if (image_.sample == Sample::byte) {
      const std::uint8_t* from = image_.data.data() + at * channels;
      for (std::size_t c = 0; c < channels; ++c) pixel[c] = c == 3 ? plain_[from[c]] : table_[from[c]];
    } else {
      for (std::size_t c = 0; c < channels; ++c) {
        const std::uint16_t word = word_at(image_, at * channels + c);
        pixel[c] = image_.sample == Sample::word ? static_cast<float>(word) / 65535 : float_from_half(word);
      }
    }
    if (by_alpha_)
      for (std::size_t c = 0; c + 1 < channels; ++c) pixel[c] *= pixel[channels - 1];
    return pixel;
  }
  /// The mean of 2x2 pixels from `at` on.
  Pixel<channels> mean_of_four(std::size_t at, std::size_t width) const {
    const SampleReader& read = *this;
    if (channels == 4 && image_.sample == Sample::byte) {
      const std::uint8_t *up = image_.data.data() + 4 * at, *down = up + 4 * width;
      if ((up[3] & up[7] & down[3] & down[7]) == 255) return mean_of_opaque(up, down);
    }
    return mean_of_pixels<channels>(read(at), read(at + 1), read(at + width), read(at + width + 1));
  }

 private:
  /// The same, to the bit, without the work for alpha.
  Pixel<channels> mean_of_opaque(const std::uint8_t* up, const std::uint8_t* down) const {
    Pixel<channels> mean;
    for (std::size_t c = 0; c < channels; ++c)
      mean[c] =
          c == 3 ? 1 : 0.25f * (table_[up[c]] + table_[up[4 + c]] + table_[down[c]] + table_[down[4 + c]]);
    return mean;
  }

  const StoredImage& image_;
  bool by_alpha_;
  std::array<float, 256> table_{}, plain_{};
};

/// Which pixels of an edge make pixel `i` of the half edge, from 2 i on, and their weights.
std::array<float, 3> weights_of(int edge, int i) {
  if (edge == 1) return {1, 0, 0};
  if (edge % 2 == 0) return {0.5f, 0.5f, 0};
  const auto n = static_cast<float>(edge);
  const int half = edge / 2;
  return {static_cast<float>(half - i) / n, static_cast<float>(half) / n, static_cast<float>(i + 1) / n};
}

/// The weighted mean of up to 3x3 pixels from `at` on, of an edge that is odd.
template <std::size_t channels, class Read>
Pixel<channels> weighted_mean(const Read& read, std::size_t at, std::size_t width,
                              const std::array<float, 3>& across, const std::array<float, 3>& down) {
  Pixel<channels> sum{};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const float weight = down[j] * across[i];
      if (weight == 0) continue;
      const Pixel<channels> pixel = read(at + j * width + i);
      for (std::size_t c = 0; c < channels; ++c) sum[c] += weight * pixel[c];
    }
  return sum;
}

/// Rounds what is not negative.
std::size_t rounded(float value) {
  return static_cast<std::size_t>(value + 0.5f);  // NOLINT(bugprone-incorrect-roundings): faster than lround
}

float unit_clamped(float value) { return std::clamp(value, 0.0f, 1.0f); }

std::uint16_t word_of(float value, Sample kind) {
  return kind == Sample::half ? half_from_float(value)
                              : static_cast<std::uint16_t>(rounded(unit_clamped(value) * 65535));
}

/// Writes `count` pixels of linear floats as samples. `table` is that of sRGB bytes, or none where they are
/// linear; colours (`srgb`) are divided by their alpha.
template <std::size_t channels>
void store_pixels(const float* from, std::size_t count, Sample kind, bool srgb, std::uint8_t* to) {
  const std::uint8_t* table = srgb ? srgb_bytes().data() : nullptr;
  for (std::size_t i = 0; i < count; ++i, from += channels) {
    const float alpha = srgb && channels == 4 ? from[channels - 1] : 1;
    const float scale = alpha == 1 ? 1 : alpha > 0 ? 1 / alpha : 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const float value = c == 3 ? from[c] : from[c] * scale;
      if (kind == Sample::byte) {
        *to++ = table && c != 3 ? table[rounded(unit_clamped(value) * static_cast<float>(srgb_steps))]
                                : static_cast<std::uint8_t>(rounded(unit_clamped(value) * 255));
      } else {
        const std::uint16_t word = word_of(value, kind);
        std::memcpy(to, &word, 2);
        to += 2;
      }
    }
  }
}

/// A level and its samples.
struct Halved {
  LinearLevel linear;
  StoredImage stored;
};

/// Row by row, the samples while the row is at hand.
template <std::size_t channels, class Read>
Halved halve(int width, int height, const Read& read, Sample kind, bool srgb) {
  Halved out{{std::max(1, width / 2), std::max(1, height / 2), channels, {}}, {}};
  LinearLevel& level = out.linear;
  out.stored.width = level.width;
  out.stored.height = level.height;
  out.stored.channels = static_cast<int>(channels);
  out.stored.sample = kind;
  const auto columns = static_cast<std::size_t>(level.width), from_row = static_cast<std::size_t>(width);
  const std::size_t row = columns * channels, stored_row = columns * out.stored.pixel_bytes();
  level.data.resize(static_cast<std::size_t>(level.height) * row);
  out.stored.data.resize(static_cast<std::size_t>(level.height) * stored_row);
  const bool even = width % 2 == 0 && height % 2 == 0;
  tbb::parallel_for(tbb::blocked_range<int>(0, level.height, 16), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) {
      float* const begin = level.data.data() + static_cast<std::size_t>(y) * row;
      float* to = begin;
      std::size_t at = 2 * static_cast<std::size_t>(y) * from_row;
      for (int x = 0; x < level.width; ++x, to += channels, at += 2) {
        const Pixel<channels> mean =
            even ? read.mean_of_four(at, from_row)
                 : weighted_mean<channels>(read, at, from_row, weights_of(width, x), weights_of(height, y));
        std::copy(mean.begin(), mean.end(), to);
      }
      store_pixels<channels>(begin, columns, kind, srgb,
                             out.stored.data.data() + static_cast<std::size_t>(y) * stored_row);
    }
  });
  return out;
}

Halved halve(const LinearLevel& from, Sample kind, bool srgb) {
  if (from.channels == 1) return halve<1>(from.width, from.height, LevelReader<1>(from), kind, srgb);
  return halve<4>(from.width, from.height, LevelReader<4>(from), kind, srgb);
}

Halved halve(const StoredImage& from, bool srgb) {
  if (from.channels == 1)
    return halve<1>(from.width, from.height, SampleReader<1>(from, srgb), from.sample, srgb);
  return halve<4>(from.width, from.height, SampleReader<4>(from, srgb), from.sample, srgb);
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
  Halved level = halve(image, srgb);
  levels.push_back(std::move(level.stored));
  while (level.linear.width > 1 || level.linear.height > 1) {
    level = halve(level.linear, image.sample, srgb);
    levels.push_back(std::move(level.stored));
  }
  return levels;
}

StoredImage half_size(const StoredImage& image, bool srgb) { return halve(image, srgb).stored; }

}  // namespace sundog
