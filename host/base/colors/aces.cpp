// Computes the transform in four steps (glow, red modifier, reference curve, screen curve) with the numbers
// of the Academy's transforms.
#include "base/colors/aces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "base/colors/color_space.h"

namespace sundog {
namespace {

using glm::dmat3;
using glm::dvec3;

double saturation(const dvec3& c) {
  const double most = std::max({c.x, c.y, c.z}), least = std::min({c.x, c.y, c.z});
  return (std::max(most, 1e-10) - std::max(least, 1e-10)) / std::max(most, 1e-2);
}

/// Rises smoothly from 0 at x = -2 to 1 at x = 2.
double smooth_step(double x) {
  const double t = std::max(1 - std::abs(x / 2), 0.0);
  return 0.5 + std::copysign(0.5 * (1 - t * t), x);
}

/// Brightens dark, saturated colours.
dvec3 with_glow(const dvec3& c) {
  constexpr double gain = 0.05, middle = 0.08, chroma_weight = 1.75;
  const double chroma = std::sqrt(std::max(0.0, c.z * (c.z - c.y) + c.y * (c.y - c.x) + c.x * (c.x - c.z)));
  const double brightness = (c.x + c.y + c.z + chroma_weight * chroma) / 3;
  const double fading = std::clamp(middle / std::max(brightness, 1e-10) - 0.5, 0.0, 1.0);
  return c * (1 + gain * smooth_step((saturation(c) - 0.4) / 0.2) * fading);
}

/// A cubic B-spline of width 1 around 0, scaled to 1 at 0.
double bump(double x) {
  const double t = 4 * std::abs(x);
  if (t >= 2) return 0;
  return 1.5 * (t < 1 ? 2.0 / 3 - t * t + t * t * t / 2 : (2 - t) * (2 - t) * (2 - t) / 6);
}

/// Darkens saturated reds.
dvec3 with_tamed_red(dvec3 c) {
  constexpr double scale = 0.82, pivot = 0.03, width = 135;  // degrees of hue
  const double hue = std::atan2(std::sqrt(3.0) * (c.y - c.z), 2 * c.x - c.y - c.z) * 180 / std::numbers::pi;
  c.x += bump(hue / width) * saturation(c) * (pivot - c.x) * (1 - scale);
  return c;
}

/// A uniform quadratic B-spline from `begin` to `end`.
struct Segment {
  double begin, end;
  std::span<const double> coefficients;

  double at(double x) const {
    const auto pieces = static_cast<double>(coefficients.size() - 2);
    const double place = std::clamp((x - begin) / (end - begin), 0.0, 1.0) * pieces;
    const auto i = static_cast<std::size_t>(std::min(place, pieces - 1));
    const double t = place - static_cast<double>(i);
    const double a = coefficients[i], b = coefficients[i + 1], c = coefficients[i + 2];
    return (a / 2 - b + c / 2) * t * t + (b - a) * t + (a + b) / 2;
  }
};

/// Maps the decimal logarithm of the scene's luminance to that of a 10,000-nit cinema screen, in nits.
double reference_curve(double x) {
  static constexpr std::array<double, 6> low = {-4,           -4,          -3.1573765773, -0.4852499958,
                                                1.8477324706, 1.8477324706},
                                         high = {-0.7185482425, 2.0810307172, 3.6681241237, 4, 4, 4};
  static const double middle = std::log10(0.18), stops = std::log10(2);
  const Segment dark{middle - 15 * stops, middle, std::span(low).first(5)};
  const Segment bright{middle, middle + 18 * stops, std::span(high).first(5)};
  return x < middle ? dark.at(x) : bright.at(x);
}

/// Maps the result of reference_curve() to the decimal logarithm of nits on a 48-nit screen.
double screen_curve(double x) {
  static constexpr std::array<double, 10> low = {-1.6989700043, -1.6989700043, -1.4779, -1.2291,
                                                 -0.8648,       -0.448,        0.00518, 0.4511080334,
                                                 0.9113744414,  0.9113744414},
                                          high = {0.5154386965, 0.8470437783, 1.1358, 1.3802,
                                                  1.5197,       1.5985,       1.6467, 1.6746091357,
                                                  1.687873339,  1.687873339};
  static const double middle = std::log10(0.18), stops = 6.5 * std::log10(2);
  static const double begin = reference_curve(middle - stops), pivot = reference_curve(middle),
                      end = reference_curve(middle + stops);
  constexpr double slope_beyond = 0.04;
  if (x > end) return std::log10(48.0) + slope_beyond * (x - end);
  return x < pivot ? Segment{begin, pivot, std::span(low).first(9)}.at(x)
                   : Segment{pivot, end, std::span(high).first(9)}.at(x);
}

/// The screen's linear value for a channel: 0 at black, 1 at white.
double shown(double light) {
  constexpr double black = 0.02, white = 48;
  const double nits = std::pow(10, screen_curve(reference_curve(std::log10(std::max(light, 1e-10)))));
  return (nits - black) / (white - black);
}

}  // namespace

dvec3 aces_output(const dvec3& color) {
  static const dmat3 ap0_from_srgb = conversion(srgb_primaries, ap0_primaries),
                     ap1_from_ap0 = conversion(ap0_primaries, ap1_primaries),
                     srgb_from_ap1 = conversion(ap1_primaries, srgb_primaries);
  static const dvec3 luminance = glm::transpose(xyz_from(ap1_primaries))[1];
  constexpr double scene_saturation = 0.96, screen_saturation = 0.93, dim_surround = 0.9811;
  const auto saturated = [](const dvec3& c, double amount) {
    return glm::mix(dvec3(glm::dot(luminance, c)), c, amount);
  };
  const dvec3 seen = glm::max(with_tamed_red(with_glow(ap0_from_srgb * color)), dvec3(0));
  dvec3 c = saturated(glm::max(ap1_from_ap0 * seen, dvec3(0)), scene_saturation);
  c = {shown(c.x), shown(c.y), shown(c.z)};
  c *= std::pow(std::max(glm::dot(luminance, c), 1e-10), dim_surround - 1);
  return glm::max(srgb_from_ap1 * saturated(c, screen_saturation), dvec3(0));
}

}  // namespace sundog
