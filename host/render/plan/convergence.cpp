// Weighs a pixel's change, its neighbours' change and the variance of colours around it; after one sample
// only the variance is known.
#include "render/plan/convergence.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sundog {
namespace {

// Weights of the error indicators, found by experiment: with these, the scenes antialiasing, spheres and
// hollow_ice reach the error of 16 uniform samples with the fewest samples.
constexpr float own = 0.4f, neighbors = 0.1f, variation = 0.15f;
constexpr float variation_of_one = 0.5f, wider_of_one = 0.3f;

// Factor of the pooled changes, found by experiment: at a threshold of 0.02, cornell_path takes the samples
// that it takes by the weights above.
constexpr float pooled = 0.4f;

/// The sum of the values in a pixel's 3x3 neighbourhood, clipped to the image, and their number.
template <class Value>
struct Around {
  Value sum{};
  float count;
};

/// Neighbourhood sums of a film's `seen` and `moved_by_one`.
struct SeenAround {
  Around<Seen> seen;
  float moved;
};

SeenAround sum_3x3(const Film& film, std::size_t x, std::size_t y) {
  const auto width = static_cast<std::size_t>(film.width);
  const auto height = static_cast<std::size_t>(film.height);
  const std::size_t left = x - (x > 0), right = std::min(x + 1, width - 1);
  const std::size_t top = y - (y > 0), bottom = std::min(y + 1, height - 1);
  SeenAround around{{{}, static_cast<float>((right - left + 1) * (bottom - top + 1))}, 0};
  for (std::size_t u = left; u <= right; ++u) {
    Seen column{};
    float moved = 0;
    for (std::size_t v = top; v <= bottom; ++v) {
      column += film.seen[v * width + u];
      moved += film.moved_by_one[v * width + u];
    }
    around.seen.sum += column;
    around.moved += moved;
  }
  return around;
}

void prefetch_3x3(const Film& film, u32 pixel) {
  const auto width = static_cast<std::size_t>(film.width);
  const std::size_t x = pixel & 0xffffu, y = pixel >> 16;
  for (std::size_t v = y - (y > 0); v <= std::min(y + 1, static_cast<std::size_t>(film.height) - 1); ++v) {
    __builtin_prefetch(&film.seen[v * width + x]);
    __builtin_prefetch(&film.moved_by_one[v * width + x]);
  }
}

/// Calls visit(p, around) for all pixels, row by row; column sums are shared by three pixels.
template <class Value, class Visit>
void for_all_3x3(const std::vector<Value>& values, std::size_t width, const Visit& visit) {
  const std::size_t height = values.size() / width, rows_at_once = pixels_at_once / width + 1;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, height, rows_at_once), [&](const auto& rows) {
    std::vector<Value> columns(width);
    for (std::size_t y = rows.begin(); y != rows.end(); ++y) {
      const Value *above = &values[(y - (y > 0)) * width], *row = &values[y * width];
      const Value* below = &values[std::min(y + 1, height - 1) * width];
      for (std::size_t x = 0; x < width; ++x) {
        Value column = above[x];
        if (row != above) column += row[x];
        if (below != row) column += below[x];
        columns[x] = column;
      }
      const std::size_t high = 1 + (y > 0) + (y + 1 < height);
      for (std::size_t x = 0; x < width; ++x) {
        Value sum = x > 0 ? columns[x - 1] : Value{};
        sum += columns[x];
        if (x + 1 < width) sum += columns[x + 1];
        visit(y * width + x, Around<Value>{sum, static_cast<float>(high * (1 + (x > 0) + (x + 1 < width)))});
      }
    }
  });
}

/// Variance of the colours around a pixel, in the units of squared pixel_errors().
float color_variance(const Seen& pixel, const Around<Seen>& around) {
  const Seen& sum = around.sum;
  const float of_means =
      (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / (around.count * around.count);
  constexpr float channels = 3;  // pixel_errors() sums the channels' errors before squaring
  return channels * std::max(0.0f, sum[3] / around.count - of_means) /
         std::sqrt(seen_light({pixel[0], pixel[1], pixel[2]}));
}

/// Mean of `values`, row by row in the film, over the 5x5 pixels around, clipped to the image.
float mean_5x5(const Film& film, const std::vector<float>& values, std::size_t x, std::size_t y) {
  const auto width = static_cast<std::size_t>(film.width), height = static_cast<std::size_t>(film.height);
  const std::size_t left = x - std::min<std::size_t>(x, 2), right = std::min(x + 2, width - 1);
  const std::size_t top = y - std::min<std::size_t>(y, 2), bottom = std::min(y + 2, height - 1);
  float sum = 0;
  for (std::size_t v = top; v <= bottom; ++v)
    for (std::size_t u = left; u <= right; ++u) sum += values[v * width + u];
  return sum / static_cast<float>((right - left + 1) * (bottom - top + 1));
}

/// Infinite colours make the error NaN; it becomes infinite, because sorting needs ordered numbers.
float known(float square) { return std::isnan(square) ? std::numeric_limits<float>::infinity() : square; }

}  // namespace

std::vector<float> expected_squares_of_one(const Film& film) {
  const auto width = static_cast<std::size_t>(film.width);
  const std::vector<Seen>& seen = film.seen;
  std::vector<float> variances(seen.size()), squares(seen.size());
  for_all_3x3(seen, width, [&](std::size_t p, const Around<Seen>& around) {
    variances[p] = color_variance(seen[p], around);
  });
  for_all_3x3(variances, width, [&](std::size_t p, const Around<float>& around) {
    squares[p] = known(variation_of_one * variances[p] + wider_of_one * around.sum / around.count);
  });
  return squares;
}

std::vector<float> expected_squares(const Film& film, const std::vector<u32>& pixels, u32 level) {
  const auto width = static_cast<std::size_t>(film.width);
  const std::vector<Seen>& seen = film.seen;
  std::vector<float> expected(pixels.size());
  if (level == 1) {
    const std::vector<float> squares = expected_squares_of_one(film);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      expected[i] = squares[(pixels[i] >> 16) * width + (pixels[i] & 0xffffu)];
    return expected;
  }
  const float shrunk = share_of_squares(level);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pixels.size(), pixels_at_once), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          if (i + pixels_ahead < range.end()) prefetch_3x3(film, pixels[i + pixels_ahead]);
          const std::size_t x = pixels[i] & 0xffffu, y = pixels[i] >> 16, p = y * width + x;
          const SeenAround around = sum_3x3(film, x, y);
          const float others =
              neighbors * around.moved / around.seen.count + variation * color_variance(seen[p], around.seen);
          expected[i] = known(own * film.moved[p] + shrunk * others);
        }
      });
  return expected;
}

std::vector<float> pooled_squares(const Film& film, const std::vector<u32>& pixels, u32 level) {
  if (level == 1) return expected_squares(film, pixels, level);
  const float factor = pooled * share_of_squares(level);
  std::vector<float> expected(pixels.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pixels.size(), pixels_at_once), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
          expected[i] =
              known(factor * mean_5x5(film, film.moved_by_one, pixels[i] & 0xffffu, pixels[i] >> 16));
      });
  return expected;
}

std::vector<float> block_costs(const Film& film) {
  const auto width = static_cast<u32>(film.width), height = static_cast<u32>(film.height);
  constexpr u32 edge = cost_block;
  std::vector<float> costs(cost_blocks(film.width, film.height), 1.0f);
  const double rays = std::accumulate(film.block_rays.begin(), film.block_rays.end(), 0.0);
  if (rays == 0) return costs;  // not counted
  const u32 columns = (width + edge - 1) / edge;
  const auto mean = static_cast<float>(rays / (static_cast<double>(width) * height));
  for (u32 i = 0; i < costs.size(); ++i) {
    const u32 across = std::min(edge, width - i % columns * edge);
    const u32 down = std::min(edge, height - i / columns * edge);
    costs[i] =
        static_cast<float>(std::max(1u, film.block_rays[i])) / (static_cast<float>(across * down) * mean);
  }
  return costs;
}

}  // namespace sundog
