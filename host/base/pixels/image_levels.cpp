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

 private:
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

/// The mean of 2x2 pixels from `at` on.
template <std::size_t channels, class Read>
Pixel<channels> mean_of_four(const Read& read, std::size_t at, std::size_t width) {
  const Pixel<channels> a = read(at), b = read(at + 1), c = read(at + width), d = read(at + width + 1);
  Pixel<channels> mean;
  for (std::size_t k = 0; k < channels; ++k) mean[k] = 0.25f * (a[k] + b[k] + c[k] + d[k]);
  return mean;
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

template <std::size_t channels, class Read>
LinearLevel halve(int width, int height, const Read& read) {
  LinearLevel level{std::max(1, width / 2), std::max(1, height / 2), channels, {}};
  const auto row = static_cast<std::size_t>(level.width) * channels,
             from_row = static_cast<std::size_t>(width);
  level.data.resize(static_cast<std::size_t>(level.height) * row);
  const bool even = width % 2 == 0 && height % 2 == 0;
  tbb::parallel_for(tbb::blocked_range<int>(0, level.height, 16), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) {
      float* to = level.data.data() + static_cast<std::size_t>(y) * row;
      std::size_t at = 2 * static_cast<std::size_t>(y) * from_row;
      for (int x = 0; x < level.width; ++x, to += channels, at += 2) {
        const Pixel<channels> mean =
            even ? mean_of_four<channels>(read, at, from_row)
                 : weighted_mean<channels>(read, at, from_row, weights_of(width, x), weights_of(height, y));
        std::copy(mean.begin(), mean.end(), to);
      }
    }
  });
  return level;
}

template <std::size_t channels>
LinearLevel halve(const LinearLevel& from) {
  return halve<channels>(from.width, from.height, [&](std::size_t at) {
    Pixel<channels> pixel;
    std::copy_n(from.data.data() + at * channels, channels, pixel.begin());
    return pixel;
  });
}
LinearLevel halve(const LinearLevel& from) { return from.channels == 1 ? halve<1>(from) : halve<4>(from); }

LinearLevel halve(const StoredImage& from, bool srgb) {
  if (from.channels == 1) return halve<1>(from.width, from.height, SampleReader<1>(from, srgb));
  return halve<4>(from.width, from.height, SampleReader<4>(from, srgb));
}

/// Rounds what is not negative.
std::size_t rounded(float value) {
  return static_cast<std::size_t>(value + 0.5f);  // NOLINT(bugprone-incorrect-roundings): faster than lround
}

/// `table` is that of sRGB bytes, or none where they are linear.
void write_sample(StoredImage& image, std::size_t sample, float value, const std::uint8_t* table) {
  if (image.sample == Sample::byte) {
    const float unit = std::clamp(value, 0.0f, 1.0f);
    image.data[sample] = table ? table[rounded(unit * static_cast<float>(srgb_steps))]
                               : static_cast<std::uint8_t>(rounded(unit * 255));
    return;
  }
  const std::uint16_t word = image.sample == Sample::half
                                 ? half_from_float(value)
                                 : static_cast<std::uint16_t>(rounded(std::clamp(value, 0.0f, 1.0f) * 65535));
  std::memcpy(image.data.data() + 2 * sample, &word, 2);
}

template <std::size_t channels>
void store_pixels(const LinearLevel& level, std::size_t begin, std::size_t end, bool srgb,
                  StoredImage& image) {
  const std::uint8_t* table = srgb ? srgb_bytes().data() : nullptr;
  for (std::size_t i = begin; i != end; ++i) {
    const float* from = level.data.data() + i * channels;
    const float alpha = srgb && channels == 4 ? from[channels - 1] : 1;
    const float scale = alpha == 1 ? 1 : alpha > 0 ? 1 / alpha : 0;
    for (std::size_t c = 0; c < channels; ++c)
      write_sample(image, i * channels + c, c == 3 ? from[c] : from[c] * scale, c == 3 ? nullptr : table);
  }
}

StoredImage store(const LinearLevel& level, Sample kind, bool srgb) {
  StoredImage image;
  image.width = level.width;
  image.height = level.height;
  image.channels = static_cast<int>(level.channels);
  image.sample = kind;
  image.data.resize(image.pixel_count() * image.pixel_bytes());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.pixel_count(), 4096), [&](const auto& range) {
    if (level.channels == 1)
      store_pixels<1>(level, range.begin(), range.end(), srgb, image);
    else
      store_pixels<4>(level, range.begin(), range.end(), srgb, image);
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
