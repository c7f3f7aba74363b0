// Computes up to six levels in one pass while edges are even, so that rows stay in the cache; odd edges take
// weighted means of three pixels, one level per pass.
#include "base/pixels/image_levels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/image_io.h"

namespace sundog {
namespace {

using Sample = StoredImage::Sample;

/// A level as linear floats; colours premultiplied if weighted by alpha.
struct LinearLevel {
  int width = 0, height = 0;
  std::size_t channels = 4;
  std::vector<float> data;
};

/// Maps a linear value to an sRGB byte, in steps so fine that the error is at most a quarter of a level.
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

/// A pixel's linear channels; colours premultiplied if weighted by alpha.
template <std::size_t channels>
using Pixel = std::array<float, channels>;

template <std::size_t channels>
Pixel<channels> mean_of_pixels(const Pixel<channels>& a, const Pixel<channels>& b, const Pixel<channels>& c,
                               const Pixel<channels>& d) {
  Pixel<channels> mean;
  for (std::size_t k = 0; k < channels; ++k) mean[k] = 0.25f * (a[k] + b[k] + c[k] + d[k]);
  return mean;
}

/// Reads pixels of a LinearLevel.
template <std::size_t channels>
class LevelReader {
 public:
  explicit LevelReader(const float* data) : data_(data) {}
  Pixel<channels> operator()(std::size_t at) const {
    Pixel<channels> pixel;
    std::copy_n(data_ + at * channels, channels, pixel.begin());
    return pixel;
  }
  /// Mean of the 2x2 pixels starting at `at`.
  Pixel<channels> mean_of_four(std::size_t at, std::size_t width) const {
    const LevelReader& read = *this;
    return mean_of_pixels<channels>(read(at), read(at + 1), read(at + width), read(at + width + 1));
  }
  /// Does nothing: the level's rows have already been passed on.
  void pass_rows(int, int, const TakeRow&) const {}

 private:
  const float* data_;
};

/// Reads pixels of a StoredImage as linear floats.
template <std::size_t channels>
class SampleReader {
 public:
  SampleReader(const StoredImage& image, SampleUse use)
      : image_(image), by_alpha_(use == SampleUse::color_by_alpha && channels == 4) {
    const bool srgb = use != SampleUse::data;
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
  /// Mean of the 2x2 pixels starting at `at`.
  Pixel<channels> mean_of_four(std::size_t at, std::size_t width) const {
    const SampleReader& read = *this;
    if (channels == 4 && image_.sample == Sample::byte) {
      const std::uint8_t *up = image_.data.data() + 4 * at, *down = up + 4 * width;
      if ((up[3] & up[7] & down[3] & down[7]) == 255) return mean_of_opaque(up, down);
    }
    return mean_of_pixels<channels>(read(at), read(at + 1), read(at + width), read(at + width + 1));
  }
  void pass_rows(int first, int end, const TakeRow& take) const {
    const std::size_t row = static_cast<std::size_t>(image_.width) * image_.pixel_bytes();
    for (int y = first; y < end; ++y) take(0, y, image_.data.data() + static_cast<std::size_t>(y) * row);
  }

 private:
  /// mean_of_four() for opaque pixels: equal to the bit, cheaper.
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

/// Weights of the source pixels 2 i, 2 i + 1 and 2 i + 2 for pixel `i` of the halved edge.
std::array<float, 3> weights_of(int edge, int i) {
  if (edge == 1) return {1, 0, 0};
  if (edge % 2 == 0) return {0.5f, 0.5f, 0};
  const auto n = static_cast<float>(edge);
  const int half = edge / 2;
  return {static_cast<float>(half - i) / n, static_cast<float>(half) / n, static_cast<float>(i + 1) / n};
}

/// Weighted mean of up to 3x3 pixels starting at `at`, for odd edges.
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

/// Rounds a non-negative value.
std::size_t rounded(float value) {
  return static_cast<std::size_t>(value + 0.5f);  // NOLINT(bugprone-incorrect-roundings): faster than lround
}

float unit_clamped(float value) { return std::clamp(value, 0.0f, 1.0f); }

std::uint16_t word_of(float value, Sample kind) {
  return kind == Sample::half ? half_from_float(value)
                              : static_cast<std::uint16_t>(rounded(unit_clamped(value) * 65535));
}

/// Converts `count` linear pixels to samples: sRGB for colours in bytes, else linear. Divides colours that
/// were weighted by alpha by it.
template <std::size_t channels>
void store_pixels(const float* from, std::size_t count, Sample kind, SampleUse use, std::uint8_t* to) {
  const bool by_alpha = use == SampleUse::color_by_alpha && channels == 4;
  const std::uint8_t* table = use != SampleUse::data ? srgb_bytes().data() : nullptr;
  for (std::size_t i = 0; i < count; ++i, from += channels) {
    const float alpha = by_alpha ? from[channels - 1] : 1;
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

/// Levels per pass; few enough that a task's rows stay in the cache.
constexpr int most_steps = 6;

/// Computes the levels that follow a level, holding at most two float rows per level.
template <std::size_t channels, class Read>
class LevelMaker {
 public:
  /// `read` reads level `level`.
  LevelMaker(const Read& read, int width, int height, std::size_t level, Sample kind, SampleUse use,
             const TakeRow& take)
      : read_(read), width_(width), height_(height), level_(level), kind_(kind), use_(use), take_(take) {}

  /// Makes at least one level, and up to `most` while edges are even. Returns the last level, and adds the
  /// number of levels to `made`.
  LinearLevel make(int most, std::size_t& made) {
    const auto evenly = [](int edge) { return std::countr_zero(static_cast<unsigned>(edge)); };
    even_ = width_ % 2 == 0 && height_ % 2 == 0;
    const int steps = even_ ? std::min({most, evenly(width_), evenly(height_)}) : 1;
    LinearLevel last{std::max(1, width_ >> steps), std::max(1, height_ >> steps), channels, {}};
    const std::size_t row = static_cast<std::size_t>(last.width) * channels;
    last.data.resize(static_cast<std::size_t>(last.height) * row);
    tbb::parallel_for(
        tbb::blocked_range<int>(0, last.height, static_cast<std::size_t>(std::max(1, 16 >> steps))),
        [&](const auto& rows) {
          Scratch scratch = make_scratch(steps);
          for (int y = rows.begin(); y != rows.end(); ++y)
            make_row(steps, y, last.data.data() + static_cast<std::size_t>(y) * row, scratch);
        });
    made += static_cast<std::size_t>(steps);
    return last;
  }

 private:
  /// Two float rows of each level except the last, and a row of samples.
  struct Scratch {
    std::array<std::vector<float>, most_steps> pairs;
    std::vector<std::uint8_t> samples;
  };

  int width_of(int step) const { return std::max(1, width_ >> step); }

  Scratch make_scratch(int steps) const {
    Scratch scratch;
    for (int step = 1; step < steps; ++step)
      scratch.pairs[static_cast<std::size_t>(step)].resize(2 * static_cast<std::size_t>(width_of(step)) *
                                                           channels);
    scratch.samples.resize(static_cast<std::size_t>(width_of(1)) * channels * 2);
    return scratch;
  }

  /// Makes row `y` of the level that is `step` levels after the source, after the rows that it averages.
  void make_row(int step, int y, float* to, Scratch& scratch) const {
    const auto columns = static_cast<std::size_t>(width_of(step));
    if (step == 1) {
      read_.pass_rows(2 * y, y + 1 == std::max(1, height_ / 2) ? height_ : 2 * y + 2, take_);
      make_first(y, to);
    } else {
      const std::size_t from_columns = 2 * columns;
      float* pair = scratch.pairs[static_cast<std::size_t>(step - 1)].data();
      make_row(step - 1, 2 * y, pair, scratch);
      make_row(step - 1, 2 * y + 1, pair + from_columns * channels, scratch);
      const LevelReader<channels> read(pair);
      for (std::size_t x = 0; x < columns; ++x) {
        const Pixel<channels> mean = read.mean_of_four(2 * x, from_columns);
        std::copy(mean.begin(), mean.end(), to + x * channels);
      }
    }
    store_pixels<channels>(to, columns, kind_, use_, scratch.samples.data());
    take_(level_ + static_cast<std::size_t>(step), y, scratch.samples.data());
  }

  void make_first(int y, float* to) const {
    const auto from_columns = static_cast<std::size_t>(width_);
    std::size_t at = 2 * static_cast<std::size_t>(y) * from_columns;
    for (int x = 0; x < width_of(1); ++x, to += channels, at += 2) {
      const Pixel<channels> mean =
          even_ ? read_.mean_of_four(at, from_columns)
                : weighted_mean<channels>(read_, at, from_columns, weights_of(width_, x),
                                          weights_of(height_, y));
      std::copy(mean.begin(), mean.end(), to);
    }
  }

  const Read& read_;
  int width_, height_;
  std::size_t level_;
  Sample kind_;
  SampleUse use_;
  bool even_ = false;
  const TakeRow& take_;
};

template <std::size_t channels>
void make_levels(const StoredImage& image, SampleUse use, std::size_t most, const TakeRow& take) {
  std::size_t made = 0;
  const auto next = [&](const auto& read, int width, int height) {
    using Read = std::decay_t<decltype(read)>;
    LevelMaker<channels, Read> maker(read, width, height, made, image.sample, use, take);
    return maker.make(static_cast<int>(std::min<std::size_t>(most_steps, most - made)), made);
  };
  const SampleReader<channels> read(image, use);
  if (most == 0 || image.pixel_count() == 1) return read.pass_rows(0, image.height, take);
  LinearLevel level = next(read, image.width, image.height);
  while (made < most && (level.width > 1 || level.height > 1))
    level = next(LevelReader<channels>(level.data.data()), level.width, level.height);
}

void make_levels(const StoredImage& image, SampleUse use, std::size_t most, const TakeRow& take) {
  if (image.channels == 1)
    make_levels<1>(image, use, most, take);
  else
    make_levels<4>(image, use, most, take);
}

}  // namespace

const std::array<float, 256>& linear_bytes() {
  static const auto table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < 256; ++i) values[i] = linear_from_srgb(static_cast<float>(i) / 255);
    return values;
  }();
  return table;
}

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

void each_level_row(const StoredImage& image, SampleUse use, const TakeRow& take) {
  make_levels(image, use, std::numeric_limits<std::size_t>::max(), take);
}

StoredImage half_size(const StoredImage& image, SampleUse use) {
  StoredImage half;
  half.width = std::max(1, image.width / 2);
  half.height = std::max(1, image.height / 2);
  half.channels = image.channels;
  half.sample = image.sample;
  half.data.resize(half.pixel_count() * half.pixel_bytes());
  const std::size_t row = static_cast<std::size_t>(half.width) * half.pixel_bytes();
  make_levels(image, use, 1, [&](std::size_t level, int y, const std::uint8_t* samples) {
    if (level == 1) std::memcpy(half.data.data() + static_cast<std::size_t>(y) * row, samples, row);
  });
  return half;
}

}  // namespace sundog
