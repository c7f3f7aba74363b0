// Marches rays through a spherical atmosphere in 12 bands, adds further scattering from tables of three
// orders, and stores the sky in a grid. Lengths in km.
#include "compile/sky/twilight.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compile/sky/sky.h"
#include "scene/spectra/cie.h"

namespace sundog {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr double earth = 6371, top = 100;
constexpr int bands = 12;  // of 25 nm, from 400 to 700 nm
constexpr double first_band = 400, band_width = 25;
using Spectrum = std::array<double, bands>;

/// Irradiance above the atmosphere in W/(m^2 nm) (ASTM E490) and cross-sections of ozone in 1e-21 cm^2
/// (Serdyuchenko and others 2014), means of each band.
constexpr Spectrum sunlight = {1.66, 1.77, 2.04, 1.99, 1.90, 1.89, 1.85, 1.80, 1.70, 1.62, 1.54, 1.46};
constexpr Spectrum ozone_section = {0.03, 0.11, 0.36, 0.80, 1.70, 2.80, 3.60, 4.60, 4.70, 3.20, 1.90, 1.00};
constexpr double ozone_column = 8.07e18, ozone_depth = 15;  // molecules/cm^2 in 300 DU; half width in km
constexpr double haze_albedo = 0.9, haze_g = 0.76;
constexpr double air_height = 8, haze_height = 1.2;  // scale heights: density falls to 1/e
constexpr double night = 2e-4;                       // night sky, cd/m^2 (Leinert and others 1998)

/// Amounts of air, haze and ozone: densities relative to their maximum, or these integrated along a ray in
/// km.
using Amounts = dvec3;

Amounts densities(double height) {
  return {std::exp(-height / air_height), std::exp(-height / haze_height),
          std::max(0.0, 1 - std::abs(height - 25) / ozone_depth)};
}

/// Extinction per km by air, haze and ozone at their maximum densities, for each band.
struct Air {
  std::array<Amounts, bands> extinction;

  explicit Air(double turbidity) {
    for (int i = 0; i < bands; ++i) {
      const double micrometres = (first_band + (i + 0.5) * band_width) / 1000;
      const double beta = 0.04608 * turbidity - 0.04586;  // as in sky.cpp
      extinction[std::size_t(i)] = {0.008735 * std::pow(micrometres, -4.08) / air_height,
                                    beta * std::pow(micrometres, -1.3) / haze_height,
                                    ozone_section[std::size_t(i)] * 1e-21 * ozone_column / ozone_depth};
    }
  }
};

/// Distance from a point at `height`, in a direction with this cosine to the zenith, to the ground or the top
/// of the atmosphere.
double way_out(double height, double cosine) {
  const double r = earth + height, b = r * cosine;
  const double to_ground = b * b - r * r + earth * earth;
  if (cosine < 0 && to_ground >= 0) return -b - std::sqrt(to_ground);
  return -b + std::sqrt(b * b - r * r + (earth + top) * (earth + top));
}

double height_along(double height, double cosine, double t) {
  const double r = earth + height;
  return std::max(0.0, std::sqrt(r * r + 2 * r * cosine * t + t * t) - earth);
}

/// The angle from the zenith at which the ground begins.
double horizon_angle(double height) { return pi - std::asin(std::min(1.0, earth / (earth + height))); }

struct Place {
  int index;
  double share;  // weight of the next row
};

/// The position of `at`, from 0 to 1, among `rows` rows.
Place place_of(double at, int rows) {
  const double x = std::clamp(at, 0.0, 1.0) * (rows - 1);
  const int index = std::min(int(x), rows - 2);
  return {index, x - index};
}

/// A table of columns from a height towards the sun.
class SunColumns {
 public:
  SunColumns() : logs_(std::size_t(heights * angles)) {
    tbb::parallel_for(0, heights, [&](int i) {
      const double height = top * i * i / ((heights - 1.0) * (heights - 1.0));
      for (int j = 0; j < angles; ++j) {
        const double left = 1 - j / (angles - 1.0);
        logs_[std::size_t(i * angles + j)] =
            glm::log(columns(height, horizon_angle(height) * (1 - left * left)) + least);
      }
    });
  }

  /// The columns towards the sun, which must be above the horizon at this height.
  Amounts at(double height, double angle) const {
    const Place row = place_of(std::sqrt(height / top), heights),
                column = place_of(1 - std::sqrt(std::max(0.0, 1 - angle / horizon_angle(height))), angles);
    const Amounts* first = &logs_[std::size_t(row.index * angles + column.index)];
    return glm::exp(glm::mix(glm::mix(first[0], first[1], column.share),
                             glm::mix(first[angles], first[angles + 1], column.share), row.share));
  }

 private:
  static constexpr int heights = 48, angles = 96, steps = 256;
  static constexpr double least = 1e-12;

  static Amounts columns(double height, double angle) {
    const double cosine = std::cos(angle), r = earth + height, b = r * cosine;
    const double length = (-b + std::sqrt(b * b - r * r + (earth + top) * (earth + top))) / steps;
    Amounts sum(0);
    for (int k = 0; k < steps; ++k)
      sum += length * densities(height_along(height, cosine, (k + 0.5) * length));
    return sum;
  }

  std::vector<Amounts> logs_;
};

/// A point on a ray, at a height, with the sun's angle to the zenith there.
struct Point {
  double height, sun_angle;
};

/// Integrates light along a ray from a point at `height`, whose zenith is +y. For each step, source(point,
/// densities, columns up to it, step, sum) adds light to the sum.
template <class Source>
Spectrum gather(double height, const dvec3& direction, const dvec3& sun, int steps, const Source& source) {
  Spectrum light{};
  const double length = way_out(height, direction.y);
  Amounts passed(0);
  for (int k = 0; k < steps; ++k) {  // steps grow with the distance
    const double t = length * (k + 0.5) * (k + 0.5) / (steps * steps),
                 step = length * (2 * k + 1) / (steps * steps);
    const dvec3 p = dvec3(0, earth + height, 0) + t * direction;
    const Point point{height_along(height, direction.y, t),
                      std::acos(std::clamp(glm::dot(glm::normalize(p), sun), -1.0, 1.0))};
    const Amounts dense = densities(point.height);
    source(point, dense, passed + 0.5 * step * dense, step, light);
    passed += step * dense;
  }
  return light;
}

double rayleigh_phase(double cosine) { return 3 / (16 * pi) * (1 + cosine * cosine); }

double haze_phase(double cosine) {  // Henyey and Greenstein 1941
  return (1 - haze_g * haze_g) / (4 * pi * std::pow(1 + haze_g * haze_g - 2 * haze_g * cosine, 1.5));
}

/// Mean radiance at a point from all directions, by its height and the sun's angle there: of the last order
/// of scattering, and of all orders.
class Scattered {
 public:
  Scattered(const Air& air, const SunColumns& columns, double sun_height)
      : air_(air), columns_(columns), first_angle_(pi / 2 - sun_height - reach) {
    for (int order = 0; order < orders; ++order) {
      std::vector<Spectrum> logs(std::size_t(heights * angles));
      tbb::parallel_for(0, heights * angles, [&](int i) { logs[std::size_t(i)] = mean_at(i, order > 0); });
      last_ = logs;
      for (std::size_t i = 0; i < logs.size() && order > 0; ++i)
        for (std::size_t c = 0; c < bands; ++c)
          logs[i][c] = std::log(std::exp(all_[i][c]) + std::exp(logs[i][c]));
      all_ = std::move(logs);
    }
  }

  /// The light that reaches the ground from `direction`.
  Spectrum light(const dvec3& direction, const dvec3& sun) const {
    Spectrum once = once_scattered(0, direction, sun, 64);
    const Spectrum more = again_scattered(0, direction, sun, 64, all_);
    for (std::size_t c = 0; c < bands; ++c) once[c] += more[c];
    return once;
  }

 private:
  static constexpr int heights = 16, angles = 40, orders = 3, zeniths = 16, azimuths = 6;
  static constexpr double reach = 24 * pi / 180;  // of the sun's angles on each side of the observer's

  Spectrum once_scattered(double height, const dvec3& direction, const dvec3& sun, int steps) const {
    const double cosine = glm::dot(direction, sun);
    const double by_air = rayleigh_phase(cosine), by_haze = haze_albedo * haze_phase(cosine);
    return gather(
        height, direction, sun, steps,
        [&](const Point& at, const Amounts& dense, const Amounts& passed, double step, Spectrum& sum) {
          if (at.sun_angle >= horizon_angle(at.height)) return;
          const Amounts taken = passed + columns_.at(at.height, at.sun_angle);
          for (std::size_t c = 0; c < bands; ++c) {
            const Amounts& e = air_.extinction[c];
            sum[c] += step * sunlight[c] * std::exp(-glm::dot(e, taken)) *
                      (e.x * dense.x * by_air + e.y * dense.y * by_haze);
          }
        });
  }

  Spectrum again_scattered(double height, const dvec3& direction, const dvec3& sun, int steps,
                           const std::vector<Spectrum>& logs) const {
    return gather(
        height, direction, sun, steps,
        [&](const Point& at, const Amounts& dense, const Amounts& passed, double step, Spectrum& sum) {
          const Place row = place_of(std::sqrt(at.height / top), heights),
                      column = place_of((at.sun_angle - first_angle_) / (2 * reach), angles);
          const Spectrum* first = &logs[std::size_t(row.index * angles + column.index)];
          for (std::size_t c = 0; c < bands; ++c) {
            const Amounts& e = air_.extinction[c];
            const double low = first[0][c] + column.share * (first[1][c] - first[0][c]),
                         high = first[angles][c] + column.share * (first[angles + 1][c] - first[angles][c]);
            sum[c] += step * std::exp(low + row.share * (high - low) - glm::dot(e, passed)) *
                      (e.x * dense.x + haze_albedo * e.y * dense.y);
          }
        });
  }

  /// The logarithm of the mean radiance; `again`: of light scattered from the last order, else scattered
  /// once.
  Spectrum mean_at(int place, bool again) const {
    const int row = place / angles;
    const double root = row / (heights - 1.0), height = top * root * root;
    const double angle = first_angle_ + 2 * reach * (place % angles) / (angles - 1.0);
    const dvec3 sun(std::sin(angle), std::cos(angle), 0);
    Spectrum mean{};
    for (int i = 0; i < zeniths; ++i)
      for (int j = 0; j < azimuths; ++j) {
        const double zenith = pi * (i + 0.5) / zeniths, azimuth = pi * (j + 0.5) / azimuths;
        const dvec3 d(std::sin(zenith) * std::cos(azimuth), std::cos(zenith),
                      std::sin(zenith) * std::sin(azimuth));
        const Spectrum light =
            again ? again_scattered(height, d, sun, 24, last_) : once_scattered(height, d, sun, 24);
        const double share = std::sin(zenith) * pi / (2 * zeniths * azimuths);
        for (std::size_t c = 0; c < bands; ++c) mean[c] += share * light[c];
      }
    for (double& value : mean) value = std::log(value + 1e-30);
    return mean;
  }

  const Air& air_;
  const SunColumns& columns_;
  double first_angle_;
  std::vector<Spectrum> last_, all_;  // logarithms
};

/// Linear sRGB in the unit of sky.h.
dvec3 color_of(const Spectrum& light) {
  dvec3 xyz(0);
  const auto rows = cie_rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double wavelength = SPECTRUM_FIRST + SPECTRUM_STEP * double(i);
    const double band = (wavelength - first_band) / band_width;
    if (band < 0 || band >= bands) continue;
    xyz += light[std::size_t(band)] * dvec3(rows[i].x, rows[i].y, rows[i].z);
  }
  xyz *= 683 * SPECTRUM_STEP / sky_unit;
  return linear_srgb(xyz.x, xyz.y, xyz.z);
}

constexpr int zenith_rows = 96, azimuth_columns = 96;

/// Rows are denser near the horizon, where the light changes most. `at`: from 0 at the zenith to 1.
double angle_of_row(double at) { return pi / 2 * (1 - (1 - at) * (1 - at)); }
double row_of_angle(double angle) { return 1 - std::sqrt(std::max(0.0, 1 - angle / (pi / 2))); }

}  // namespace

Twilight::Twilight(double turbidity, double sun_height) : light_(std::size_t(zenith_rows * azimuth_columns)) {
  const Air air(turbidity);
  const SunColumns sun_columns;
  const Scattered scattered(air, sun_columns, sun_height);
  const dvec3 sun(std::cos(sun_height), std::sin(sun_height), 0);
  tbb::parallel_for(0, zenith_rows * azimuth_columns, [&](int i) {
    const int row = i / azimuth_columns;
    const double zenith = angle_of_row(row / (zenith_rows - 1.0)),
                 azimuth = pi * (i % azimuth_columns) / (azimuth_columns - 1.0);
    const dvec3 d(std::sin(zenith) * std::cos(azimuth), std::cos(zenith),
                  std::sin(zenith) * std::sin(azimuth));
    light_[std::size_t(i)] = glm::max(color_of(scattered.light(d, sun)), dvec3(0)) + dvec3(night / sky_unit);
  });
}

dvec3 Twilight::radiance(double zenith, double azimuth) const {
  const double turn = std::abs(std::remainder(azimuth, 2 * pi));
  const Place row = place_of(row_of_angle(zenith), zenith_rows),
              column = place_of(turn / pi, azimuth_columns);
  const dvec3* first = &light_[std::size_t(row.index * azimuth_columns + column.index)];
  return glm::mix(glm::mix(first[0], first[1], column.share),
                  glm::mix(first[azimuth_columns], first[azimuth_columns + 1], column.share), row.share);
}

}  // namespace sundog
