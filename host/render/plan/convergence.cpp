// See convergence.h.
#include "render/plan/convergence.h"

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

/// The 3x3 pixels around one, as far as they lie in the image.
struct Around {
  std::size_t left, right, top, bottom, width;

  Around(const Film& film, std::size_t pixel) : width(static_cast<std::size_t>(film.width)) {
    const std::size_t x = pixel % width, y = pixel / width;
    left = x - (x > 0), right = std::min(x + 1, width - 1);
    top = y - (y > 0), bottom = std::min(y + 1, static_cast<std::size_t>(film.height) - 1);
  }
  float count() const { return static_cast<float>((right - left + 1) * (bottom - top + 1)); }

  /// Calls visit(index) for each of them.
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t y = top; y <= bottom; ++y)
      for (std::size_t x = left; x <= right; ++x) visit(y * width + x);
  }
};

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

std::vector<Color> mean_colors(const Film& film) {
  std::vector<Color> colors(film.done.size());
  for (std::size_t p = 0; p < colors.size(); ++p) colors[p] = color_at(film, p);
  return colors;
}

/// How much colours vary about a pixel: their variance in the units of squared pixel_errors().
float color_variance(const Film& film, const std::vector<Color>& colors, std::size_t pixel) {
  const Around around(film, pixel);
  float sum[3] = {0, 0, 0}, squares = 0;
  around.each([&](std::size_t p) {
    const float channels[3] = {colors[p].r, colors[p].g, colors[p].b};
    for (int c = 0; c < 3; ++c) sum[c] += channels[c], squares += channels[c] * channels[c];
  });
  const float n = around.count();
  const float of_means = (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / (n * n);
  const Color& color = colors[pixel];
  constexpr float channels = 3;  // pixel_errors() adds up the channels' errors before they are squared
  return channels * std::max(0.0f, squares / n - of_means) / std::sqrt(seen_light(color));
}

/// Of pixels with one sample: how much colours vary about each, and about its neighbours.
void of_one_sample(const GrowingFilm& film, const std::vector<Color>& colors, std::vector<float>& expected) {
  std::vector<float> variances(colors.size());
  for (std::size_t p = 0; p < variances.size(); ++p) variances[p] = color_variance(film.film, colors, p);
  for (std::size_t p = 0; p < variances.size(); ++p) {
    if (film.taken[p] != 1) continue;
    const Around around(film.film, p);
    float wider = 0;
    around.each([&](std::size_t q) { wider += variances[q]; });
    expected[p] = variation_of_one * variances[p] + wider_of_one * wider / around.count();
  }
}

/// Of pixels with `level` samples, which were doubled before.
void of_doublings(const GrowingFilm& film, const std::vector<Color>& colors, u32 level,
                  std::vector<float>& expected) {
  for (std::size_t p = 0; p < colors.size(); ++p) {
    if (film.taken[p] != level) continue;
    const Around around(film.film, p);
    float moved = 0;
    around.each([&](std::size_t q) {
      if (film.taken[q] > 1) moved += film.moved[q] * shrunk(level) / shrunk(film.taken[q]);
    });
    expected[p] = own * film.moved[p] + neighbors * moved / around.count() +
                  variation * shrunk(level) * color_variance(film.film, colors, p);
  }
}

}  // namespace

std::vector<float> expected_squares(const GrowingFilm& film, u32 level) {
  const std::vector<Color> colors = mean_colors(film.film);
  std::vector<float> expected(colors.size());
  if (level == 1)
    of_one_sample(film, colors, expected);
  else
    of_doublings(film, colors, level, expected);
  for (float& square : expected)  // of infinite pixels nothing is known, and sorting needs an order
    if (std::isnan(square)) square = std::numeric_limits<float>::infinity();
  return expected;
}

}  // namespace sundog
