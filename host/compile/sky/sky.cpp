// Evaluates Perez's formula relative to the zenith, and dims sunlight by air, haze and ozone (Preetham,
// Shirley and Smits 1999, "A Practical Analytic Model for Daylight").
#include "compile/sky/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sundog {
namespace {

using glm::dvec3;

constexpr double unit = sky_unit / 1000;  // kcd/m^2

dvec3 perez(const dvec3* c, double cos_zenith, double sun) {
  const double cosine = std::cos(sun);
  dvec3 value;
  for (int i = 0; i < 3; ++i)
    value[i] = (1 + c[0][i] * std::exp(c[1][i] / cos_zenith)) *
               (1 + c[2][i] * std::exp(c[3][i] * sun) + c[4][i] * cosine * cosine);
  return value;
}

/// Linear sRGB of luminance and chromaticity.
dvec3 rgb_of(double luminance, double x, double y) {
  return glm::max(linear_srgb(x / y * luminance, luminance, (1 - x - y) / y * luminance), dvec3(0));
}

/// Chromaticity at the zenith: a cubic in the sun's angle with coefficients quadratic in turbidity.
double zenith_chromaticity(const double (&c)[3][4], double turbidity, double angle) {
  double sum = 0;
  for (const auto& row : c) {
    double cubic = 0;
    for (const double coefficient : row) cubic = cubic * angle + coefficient;
    sum = sum * turbidity + cubic;
  }
  return sum;
}

}  // namespace

dvec3 linear_srgb(double x, double y, double z) {
  return {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
          0.0557 * x - 0.2040 * y + 1.0570 * z};
}

Sky::Sky(double turbidity, double sun_height)
    : turbidity_(turbidity), sun_zenith_(std::numbers::pi / 2 - sun_height) {
  const double t = turbidity;
  perez_[0] = {0.1787 * t - 1.4630, -0.0193 * t - 0.2592, -0.0167 * t - 0.2608};
  perez_[1] = {-0.3554 * t + 0.4275, -0.0665 * t + 0.0008, -0.0950 * t + 0.0092};
  perez_[2] = {-0.0227 * t + 5.3251, -0.0004 * t + 0.2125, -0.0079 * t + 0.2102};
  perez_[3] = {0.1206 * t - 2.5771, -0.0641 * t - 0.8989, -0.0441 * t - 1.6537};
  perez_[4] = {-0.0670 * t + 0.3703, -0.0033 * t + 0.0452, -0.0109 * t + 0.0529};
  const double chi = (4.0 / 9 - t / 120) * (std::numbers::pi - 2 * sun_zenith_);
  static constexpr double x[3][4] = {{0.00166, -0.00375, 0.00209, 0},
                                     {-0.02903, 0.06377, -0.03202, 0.00394},
                                     {0.11693, -0.21196, 0.06052, 0.25886}};
  static constexpr double y[3][4] = {{0.00275, -0.00610, 0.00317, 0},
                                     {-0.04214, 0.08970, -0.04153, 0.00516},
                                     {0.15346, -0.26756, 0.06670, 0.26688}};
  const double luminance = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
  zenith_ = {std::max(luminance, 0.0), zenith_chromaticity(x, t, sun_zenith_),
             zenith_chromaticity(y, t, sun_zenith_)};
  perez_at_zenith_ = perez(perez_, 1, sun_zenith_);
}

dvec3 Sky::radiance(double zenith, double sun) const {
  const dvec3 value = zenith_ * perez(perez_, std::max(std::cos(zenith), 0.01), sun) / perez_at_zenith_;
  return rgb_of(std::max(value.x, 0.0), value.y, value.z) / unit;
}

dvec3 Sky::sun_irradiance() const {
  constexpr double outside = 128 / std::numbers::pi;  // klx over pi
  const double degrees = sun_zenith_ * 180 / std::numbers::pi;
  const double air = 1 / (std::cos(sun_zenith_) + 0.15 * std::pow(93.885 - degrees, -1.253));
  const double beta = 0.04608 * turbidity_ - 0.04586;  // Angstrom's coefficient
  static constexpr double micrometres[3] = {0.61, 0.55, 0.465}, ozone[3] = {0.12, 0.085, 0.014};  // 1/cm
  dvec3 kept;
  for (int i = 0; i < 3; ++i) {
    const double rayleigh = 0.008735 * std::pow(micrometres[i], -4.08),
                 haze = beta * std::pow(micrometres[i], -1.3);
    kept[i] = std::exp(-air * (rayleigh + haze + 0.35 * ozone[i]));
  }
  return kept * (outside / unit);
}

}  // namespace sundog
