// See convergence.h.
#include "render/plan/convergence.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "render/plan/pixel_rules.h"

namespace sundog {
namespace {

// How much each sign of an error counts, chosen by trial: with these numbers antialiasing, spheres and
// hollow_ice reach the error of 16 even samples with the fewest samples.
constexpr float own = 0.4f, neighbors = 0.1f, variation = 0.15f;
constexpr float variation_of_one = 0.5f, wider_of_one = 0.3f;

/// By how many times the squared error is smaller with each doubling, from 1 sample to 2^i: Sobol points do
/// better than chance, whose 1 / n^2 would be 1 / n.
float shrunk(u32 samples) {
  static const std::array<float, 32> powers = [] {
    std::array<float, 32> list{};
    for (std::size_t i = 0; i < list.size(); ++i)
      list[i] = static_cast<float>(std::pow(squares_of_doubling, static_cast<double>(i)));
    return list;
  }();
  return powers[static_cast<std::size_t>(std::bit_width(samples) - 1)];
}

/// What of a pixel counts for its neighbours: its colour, the squares of the colour's channels, and how far
/// doublings moved it, as if it had one sample.
struct Seen {
  float red = 0, green = 0, blue = 0, squares = 0, moved = 0;

  Seen& operator+=(const Seen& other) {
    red += other.red, green += other.green, blue += other.blue;
    squares += other.squares, moved += other.moved;
    return *this;
  }
};

Seen see(const GrowingFilm& film, std::size_t pixel) {
  const Color color = color_at(film.film, pixel);
  const float squares = color.r * color.r + color.g * color.g + color.b * color.b;
  const u32 taken = film.taken[pixel];
  return {color.r, color.g, color.b, squares, taken > 1 ? film.moved[pixel] / shrunk(taken) : 0};
}

/// Calls visit(first, last) for the pixels of rows, several threads at once.
template <class Visit>
void for_each_row(std::size_t width, std::size_t height, const Visit& visit) {
  constexpr std::size_t rows_at_once = 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, height, rows_at_once), [&](const auto& rows) {
    for (std::size_t y = rows.begin(); y != rows.end(); ++y) visit(y * width, (y + 1) * width);
  });
}

/// Calls visit(pixel, sum, count) for the pixels for which wants(pixel): the sum of the values of the 3x3
/// pixels around, as far as they lie in the image, and their number. Several threads at once.
template <class Value, class Wants, class Visit>
void for_each_3x3(const std::vector<Value>& values, std::size_t width, const Wants& wants,
                  const Visit& visit) {
  const std::size_t height = values.size() / width;
  for_each_row(width, height, [&](std::size_t first, std::size_t last) {
    const std::size_t top = first ? first - width : first, bottom = last < values.size() ? last : first;
    std::vector<Value> columns(width);
    for (std::size_t row = top; row <= bottom; row += width)
      for (std::size_t x = 0; x < width; ++x) columns[x] += values[row + x];
    const std::size_t rows = (bottom - top) / width + 1;
    for (std::size_t x = 0; x < width; ++x) {
      if (!wants(first + x)) continue;
      const std::size_t left = x - (x > 0), right = std::min(x + 1, width - 1);
      Value sum = columns[left];
      for (std::size_t u = left + 1; u <= right; ++u) sum += columns[u];
      visit(first + x, sum, static_cast<float>(rows * (right - left + 1)));
    }
  });
}

/// How much the `count` colours of `sum` vary about a pixel's: their variance in the units of squared
/// pixel_errors().
float color_variance(const Seen& pixel, const Seen& sum, float count) {
  const float of_means = (sum.red * sum.red + sum.green * sum.green + sum.blue * sum.blue) / (count * count);
  constexpr float channels = 3;  // pixel_errors() adds up the channels' errors before they are squared
  return channels * std::max(0.0f, sum.squares / count - of_means) /
         std::sqrt(seen_light({pixel.red, pixel.green, pixel.blue}));
}

}  // namespace

std::vector<float> expected_squares(const GrowingFilm& film, u32 level) {
  const auto width = static_cast<std::size_t>(film.film.width), all = film.taken.size();
  std::vector<Seen> seen(all);
  for_each_row(width, all / width, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) seen[p] = see(film, p);
  });
  const auto every = [](std::size_t) { return true; };
  const auto of_level = [&](std::size_t p) { return film.taken[p] == level; };
  std::vector<float> expected(all);
  if (level == 1) {
    std::vector<float> variances(all);
    for_each_3x3(seen, width, every, [&](std::size_t p, const Seen& sum, float count) {
      variances[p] = color_variance(seen[p], sum, count);
    });
    for_each_3x3(variances, width, of_level, [&](std::size_t p, float sum, float count) {
      expected[p] = variation_of_one * variances[p] + wider_of_one * sum / count;
    });
  } else {
    for_each_3x3(seen, width, of_level, [&](std::size_t p, const Seen& sum, float count) {
      const float around = neighbors * sum.moved / count + variation * color_variance(seen[p], sum, count);
      expected[p] = own * film.moved[p] + shrunk(level) * around;
    });
  }
  for (float& square : expected)  // of infinite pixels nothing is known, and sorting needs an order
    if (std::isnan(square)) square = std::numeric_limits<float>::infinity();
  return expected;
}

}  // namespace sundog
