// Adds three Gaussians, each approximated by three box filters in turn (Wells 1986, "Efficient synthesis of
// Gaussian filters by cascaded uniform filters").
#include "base/pixels/bloom.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sundog {
namespace {

/// One channel.
struct Plane {
  std::ptrdiff_t width, height;
  std::vector<double> data;
};

/// A line of a plane: every `step`th value from `start`.
struct Line {
  double* start;
  std::ptrdiff_t step, count;
};

/// Replaces each value by the mean of the values at most `reach` away, without those beyond the ends.
void average(const Line& line, std::ptrdiff_t reach, std::vector<double>& sums) {
  const auto count = line.count;
  sums.assign(static_cast<std::size_t>(count) + 1, 0);
  for (std::ptrdiff_t i = 0; i < count; ++i)
    sums[static_cast<std::size_t>(i) + 1] = sums[static_cast<std::size_t>(i)] + line.start[i * line.step];
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::ptrdiff_t from = std::max<std::ptrdiff_t>(i - reach, 0), to = std::min(i + reach + 1, count);
    line.start[i * line.step] = (sums[static_cast<std::size_t>(to)] - sums[static_cast<std::size_t>(from)]) /
                                static_cast<double>(to - from);
  }
}

void blur(Plane& plane, double deviation) {
  // A window of 2 reach + 1 values has the variance (reach + 1) reach / 3.
  const auto reach = std::lround(std::sqrt(0.25 + deviation * deviation) - 0.5);
  std::vector<double> sums;
  for (int pass = 0; pass < 3; ++pass) {
    for (std::ptrdiff_t y = 0; y < plane.height; ++y)
      average({plane.data.data() + y * plane.width, 1, plane.width}, reach, sums);
    for (std::ptrdiff_t x = 0; x < plane.width; ++x)
      average({plane.data.data() + x, plane.width, plane.height}, reach, sums);
  }
}

}  // namespace

void add_bloom(Image& image, double share) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t pixels = image.data.size() / channels;
  const auto light = [](float v) { return std::isfinite(v) ? double(v) : 0; };
  for (std::size_t c = 0; c < 3; ++c) {
    Plane sharp{image.width, image.height, std::vector<double>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) sharp.data[i] = light(image.data[i * channels + c]);
    std::vector<double> spread(pixels);
    for (const double part : {200, 50, 12}) {
      Plane bell = sharp;
      blur(bell, std::max(image.width, image.height) / part);
      for (std::size_t i = 0; i < pixels; ++i) spread[i] += bell.data[i] / 3;
    }
    for (std::size_t i = 0; i < pixels; ++i)
      if (float& value = image.data[i * channels + c]; std::isfinite(value))
        value = static_cast<float>((1 - share) * sharp.data[i] + share * spread[i]);
  }
}

}  // namespace sundog
