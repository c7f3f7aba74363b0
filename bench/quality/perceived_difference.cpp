// Blurs both pictures by the eye's contrast sensitivity, compares colours in CIELab, and raises the
// differences where edges and points differ.
#include "bench/quality/perceived_difference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace sundog {
namespace {

/// For a monitor 0.7 m wide with 3840 pixels, seen from 0.7 m.
constexpr double pixels_per_degree = 67;

using glm::dvec3;

constexpr double pi = std::numbers::pi;
constexpr double least_color_part = 0.4, least_color_value = 0.95;  // the paper's p_c and p_t
constexpr double color_power = 0.7, feature_power = 0.5;
constexpr double feature_width = 0.082;  // degrees

/// An image of `T`, row by row.
template <class T>
struct Plane {
  int width = 0, height = 0;
  std::vector<T> values;

  const T& at(int x, int y) const {
    x = std::clamp(x, 0, width - 1), y = std::clamp(y, 0, height - 1);
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// A plane with the value made(x, y) at each place.
template <class T, class Make>
Plane<T> plane(int width, int height, const Make& made) {
  Plane<T> out{width, height, {}};
  out.values.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out.values.push_back(made(x, y));
  return out;
}

/// Linear sRGB to XYZ with the white (0.95047, 1, 1.08883), divided by that white.
const glm::dmat3 whitened_xyz_from_rgb =
    glm::transpose(glm::dmat3(0.4124564 / 0.95047, 0.3575761 / 0.95047, 0.1804375 / 0.95047,  //
                              0.2126729, 0.7151522, 0.0721750,                                //
                              0.0193339 / 1.08883, 0.1191920 / 1.08883, 0.9503041 / 1.08883));
const glm::dmat3 rgb_from_whitened_xyz = glm::inverse(whitened_xyz_from_rgb);

dvec3 opponents_of(const dvec3& rgb) {
  const dvec3 xyz = whitened_xyz_from_rgb * rgb;
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}
dvec3 rgb_of(const dvec3& opponents) {
  const double y = (opponents.x + 16) / 116;
  return rgb_from_whitened_xyz * dvec3(y + opponents.y / 500, y, y - opponents.z / 200);
}

/// CIELab with Hunt's adjustment: chroma scales with lightness.
dvec3 seen_color(const dvec3& rgb) {
  const dvec3 xyz = whitened_xyz_from_rgb * glm::clamp(rgb, dvec3(0), dvec3(1));
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : t * 841 / 108 + 4.0 / 29; };
  const double x = f(xyz.x), y = f(xyz.y), z = f(xyz.z), lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double color_distance(const dvec3& a, const dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Weights of the offsets -radius..radius.
using Weights = std::vector<dvec3>;

int radius_of(const Weights& weights) { return static_cast<int>(weights.size() / 2); }

Weights weights(int radius, const std::function<dvec3(double)>& of) {
  Weights made;
  for (int i = -radius; i <= radius; ++i) made.push_back(of(i));
  return made;
}

template <class T>
Plane<T> filtered(const Plane<T>& in, const Weights& across, const Weights& down) {
  const auto one_way = [](const Plane<T>& from, const Weights& w, int dx, int dy) {
    const int radius = radius_of(w);
    return plane<T>(from.width, from.height, [&](int x, int y) {
      T sum(0);
      for (int i = -radius; i <= radius; ++i)
        sum += T(w[static_cast<std::size_t>(i + radius)]) * from.at(x + i * dx, y + i * dy);
      return sum;
    });
  };
  return one_way(one_way(in, across, 1, 0), down, 0, 1);
}

/// Filters each opponent channel by the eye's contrast sensitivity: a Gaussian for lightness and red-green,
/// the sum of two for blue-yellow.
Plane<dvec3> blurred(const Plane<dvec3>& opponents) {
  const dvec3 narrow(0.0047, 0.0053, 0.04);
  const double wide = 0.025, first = 34.1, second = 13.5;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
  const auto gaussian = [&](const dvec3& b) {
    Weights made = weights(radius, [&](double i) {
      const double x = i / pixels_per_degree;
      return glm::exp(-pi * pi * x * x / b);
    });
    const dvec3 sum = std::accumulate(made.begin(), made.end(), dvec3(0));
    for (dvec3& weight : made) weight /= sum;
    return made;
  };
  Plane<dvec3> out = filtered(opponents, gaussian(narrow), gaussian(narrow));
  const Plane<dvec3> more = filtered(opponents, gaussian(dvec3(wide)), gaussian(dvec3(wide)));
  // The peaks scale with sqrt(pi / b), the integrals with sqrt(b / pi).
  const double of_first = first * std::sqrt(narrow.z),
               share = of_first / (of_first + second * std::sqrt(wide));
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i].z = share * out.values[i].z + (1 - share) * more.values[i].z;
  return out;
}

/// Strength of edges and points in lightness from 0 to 1.
struct Features {
  Plane<double> edges, points;
};

Features features_of(const Plane<double>& lightness) {
  const double deviation = 0.5 * feature_width * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto bell = [&](double i) { return std::exp(-i * i / (2 * deviation * deviation)); };
  /// Scales positive and negative weights to a sum of 1 each.
  const auto balanced = [](Weights w) {
    dvec3 above(0), below(0);
    for (const dvec3& weight : w) above += glm::max(weight, dvec3(0)), below -= glm::min(weight, dvec3(0));
    for (dvec3& weight : w) weight /= weight.x > 0 ? above : below.x > 0 ? below : dvec3(1);
    return w;
  };
  const Weights smooth = balanced(weights(radius, [&](double i) { return dvec3(bell(i)); }));
  const Weights slope = balanced(weights(radius, [&](double i) { return dvec3(-i * bell(i)); }));
  const Weights bend = balanced(
      weights(radius, [&](double i) { return dvec3((i * i / (deviation * deviation) - 1) * bell(i)); }));
  const auto strength = [&](const Weights& weight) {
    const auto in_plane = [&](const Weights& across, const Weights& down) {
      Plane<dvec3> wide{lightness.width, lightness.height, {}};
      for (const double value : lightness.values) wide.values.emplace_back(value);
      return filtered(wide, across, down);
    };
    const Plane<dvec3> x = in_plane(weight, smooth), y = in_plane(smooth, weight);
    return plane<double>(lightness.width, lightness.height,
                         [&](int i, int j) { return std::hypot(x.at(i, j).x, y.at(i, j).x); });
  };
  return {strength(slope), strength(bend)};
}

/// Colours and features of a picture, for comparison.
struct Looks {
  Plane<dvec3> colors;
  Features features;
};

Looks looks_of(const Image& image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  std::size_t at = 0;
  const auto opponents = plane<dvec3>(image.width, image.height, [&](int, int) {
    dvec3 rgb(0);
    for (int c = 0; c < 3; ++c) {
      const double value = image.data[at + static_cast<std::size_t>(c)];
      rgb[c] = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0;
    }
    at += channels;
    return opponents_of(rgb);
  });
  Looks looks;
  looks.colors = blurred(opponents);
  for (dvec3& color : looks.colors.values) color = seen_color(rgb_of(color));
  looks.features = features_of(plane<double>(
      image.width, image.height, [&](int x, int y) { return (opponents.at(x, y).x + 16) / 116; }));
  return looks;
}

/// The distance of colours, mapped to [0, 1], with most of the range for common distances.
double color_difference(const dvec3& a, const dvec3& b) {
  static const double most =
      std::pow(color_distance(seen_color({0, 1, 0}), seen_color({0, 0, 1})), color_power);
  const double distance = std::pow(color_distance(a, b), color_power), knee = least_color_part * most;
  if (distance < knee) return least_color_value / knee * distance;
  return std::min(least_color_value + (distance - knee) / (most - knee) * (1 - least_color_value), 1.0);
}

}  // namespace

std::vector<float> perceived_differences(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels < 3 || b.channels < 3)
    throw std::invalid_argument("perceived_differences: wanted two images of one size with colours");
  const Looks one = looks_of(a), other = looks_of(b);
  std::vector<float> differences;
  for (std::size_t i = 0; i < one.colors.values.size(); ++i) {
    const double color = color_difference(one.colors.values[i], other.colors.values[i]);
    const double edges = std::abs(one.features.edges.values[i] - other.features.edges.values[i]);
    const double points = std::abs(one.features.points.values[i] - other.features.points.values[i]);
    const double feature =
        std::min(std::pow(std::max(edges, points) / std::numbers::sqrt2, feature_power), 1.0);
    differences.push_back(static_cast<float>(std::pow(color, 1 - feature)));
  }
  return differences;
}

double perceived_difference(const Image& a, const Image& b) {
  const std::vector<float> differences = perceived_differences(a, b);
  if (differences.empty()) return 0;
  return std::accumulate(differences.begin(), differences.end(), 0.0) /
         static_cast<double>(differences.size());
}

}  // namespace sundog
