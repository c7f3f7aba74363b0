// Collects the differences of all pixels, where a pixel differs by its worst channel, and colours them.
#include "base/image_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sundog {
namespace {

using Rgb = std::array<float, 3>;
constexpr double infinity = std::numeric_limits<double>::infinity();

void check_sizes(const Image& a, const Image& b, int channels) {
  if (a.width != b.width || a.height != b.height) throw std::invalid_argument("the images differ in size");
  if (a.channels < channels || b.channels < channels)
    throw std::invalid_argument("the images lack channels that are to be compared");
}

double channel_difference(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  if (!std::isfinite(a) || !std::isfinite(b)) return infinity;
  return std::abs(static_cast<double>(a) - static_cast<double>(b));
}

double pixel_difference(const float* a, const float* b, int channels) {
  double worst = 0;
  for (int c = 0; c < channels; ++c) worst = std::max(worst, channel_difference(a[c], b[c]));
  return worst;
}

bool is_finite(const float* pixel, int channels) {
  return std::all_of(pixel, pixel + channels, [](float value) { return std::isfinite(value); });
}

/// Calls `visit(pixel of a, pixel of b)` for all pixels.
template <class Visit>
void for_each_pixel(const Image& a, const Image& b, const Visit& visit) {
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) visit(a.pixel(x, y), b.pixel(x, y));
}

/// The smallest difference that at least 99 % of the pixels do not exceed. Reorders its input.
double percentile_99(std::vector<double>& differences) {
  if (differences.empty()) return 0;
  const std::size_t rank = (differences.size() * 99 + 99) / 100 - 1;
  const auto nth = differences.begin() + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(differences, nth);
  return *nth;
}

Rgb heat(double difference) {
  if (!std::isfinite(difference)) return {1, 0, 1};
  constexpr std::array<Rgb, 5> ramp = {Rgb{0, 0, 1}, {0, 1, 1}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
  const double place = std::clamp((std::log10(difference) + 5) / 5, 0.0, 1.0) * (ramp.size() - 1);
  const std::size_t left = std::min(static_cast<std::size_t>(place), ramp.size() - 2);
  const auto t = static_cast<float>(place - static_cast<double>(left));
  Rgb color;
  for (std::size_t c = 0; c < 3; ++c) color[c] = ramp[left][c] * (1 - t) + ramp[left + 1][c] * t;
  return color;
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b, double tolerance, int channels) {
  check_sizes(a, b, channels);
  ImageDifference result;
  std::vector<double> differences;
  double sum = 0, squares = 0;
  std::uint64_t finite_channels = 0;
  for_each_pixel(a, b, [&](const float* p, const float* q) {
    const double worst = pixel_difference(p, q, channels);
    differences.push_back(worst);
    result.differing += worst > 0;
    result.over_tolerance += worst > tolerance;
    result.non_finite += !is_finite(p, channels) || !is_finite(q, channels);
    for (int c = 0; c < channels; ++c) {
      const double d = channel_difference(p[c], q[c]);
      if (!std::isfinite(d)) continue;
      sum += d;
      squares += d * d;
      ++finite_channels;
    }
  });
  const double count = static_cast<double>(std::max<std::uint64_t>(finite_channels, 1));
  result.pixels = differences.size();
  result.mean = sum / count;
  result.rms = std::sqrt(squares / count);
  result.psnr = squares > 0 ? -20 * std::log10(result.rms) : infinity;
  result.max = differences.empty() ? 0 : *std::ranges::max_element(differences);
  result.percentile_99 = percentile_99(differences);
  return result;
}

Image difference_image(const Image& a, const Image& b, int channels) {
  check_sizes(a, b, channels);
  Image shown(a.width, a.height, 3);
  float* to = shown.data.data();
  for_each_pixel(a, b, [&](const float* p, const float* q) {
    const double difference = pixel_difference(p, q, channels);
    const float luminance = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
    const float grey = std::isfinite(luminance) ? std::clamp(luminance, 0.0f, 1.0f) * 0.2f : 0;
    const Rgb color = difference > 0 ? heat(difference) : Rgb{grey, grey, grey};
    to = std::ranges::copy(color, to).out;
  });
  return shown;
}

}  // namespace sundog
