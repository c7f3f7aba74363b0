// Integrates the lobes of kernels/plain/shade/layer_lobes.cl over a grid of directions; the matte ground's
// albedo weights sums that are computed once.
#include "compile/layers/albedos.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sundog {
namespace {

using glm::dvec3;

constexpr double half_turn = std::numbers::pi;

double matte_part(double c, double roughness) {
  const double d = 1 - c;
  return 1 + roughness * d * (0.0571085289 + d * (0.491881867 + d * (-0.332181442 + d * 0.0714429953)));
}

constexpr int matte_viewers = 12;

dvec3 matte_viewer(int k) { return viewer(std::max(k / 11.0, 0.01), 0); }

/// Integrates `value(wi)` over directions, weighted by the cosine.
template <class Value>
double over_hemisphere(int rows, int columns, const Value& value) {
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double z = (i + 0.5) / rows, side = std::sqrt(1 - z * z), turn = half_turn * (j + 0.5) / columns;
      const dvec3 wi(side * std::cos(turn), side * std::sin(turn), z);
      sum += value(wi) * wi.z;
    }
  return sum * 2 / (rows * columns);
}

/// Integrals over wi of a white matte ground's terms, by the column of `past` that weights them: 1, the term
/// of wi, and for each viewer the term of both directions.
struct MatteSums {
  AlbedoRow plain{}, part{};
  std::array<AlbedoRow, matte_viewers> both{};
};

MatteSums make_matte_sums() {
  MatteSums sums;
  constexpr int rows = 32, columns = 48;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double z = (i + 0.5) / rows, side = std::sqrt(1 - z * z), turn = half_turn * (j + 0.5) / columns;
      const double weight = z * 2 / (rows * columns), x = z * (LAYER_STEPS - 1);
      const auto left = std::min(static_cast<std::size_t>(x), std::size_t{LAYER_STEPS - 2});
      const auto add = [&](AlbedoRow& to, double value) {
        to[left] += weight * value * (1 - (x - double(left)));
        to[left + 1] += weight * value * (x - double(left));
      };
      add(sums.plain, 1);
      add(sums.part, matte_part(z, 1) - 1);
      for (int k = 0; k < matte_viewers; ++k) {
        const dvec3 wo = matte_viewer(k);
        const double s = wo.x * side * std::cos(turn);
        add(sums.both[static_cast<std::size_t>(k)], s > 0 ? s / std::max(wo.z, z) : s);
      }
    }
  return sums;
}

double weighed(const AlbedoRow& sums, const AlbedoRow& past) {
  return std::inner_product(sums.begin(), sums.end(), past.begin(), 0.0);
}

}  // namespace

double layer_cosine(std::size_t column) { return std::max(double(column) / (LAYER_STEPS - 1), 0.01); }

double at_cosine(const AlbedoRow& row, double cosine) {
  const double x = std::clamp(cosine, 0.0, 1.0) * (LAYER_STEPS - 1);
  const auto left = std::min(static_cast<std::size_t>(x), std::size_t{LAYER_STEPS - 2});
  return std::lerp(row[left], row[left + 1], x - double(left));
}

dvec3 viewer(double cosine, double turn) {
  const double side = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  return {side * std::cos(turn), side * std::sin(turn), cosine};
}

AlbedoRow fuzz_albedo(double alpha) {
  AlbedoRow albedo{};
  tbb::parallel_for(std::size_t{0}, std::size_t{LAYER_STEPS}, [&](std::size_t i) {
    const dvec3 wo = viewer(layer_cosine(i), 0);
    albedo[i] = over_hemisphere(48, 96, [&](const dvec3& wi) {
      const dvec3 h = glm::normalize(wo + wi);
      const double fibres = (2 + 1 / alpha) / 2 * std::pow(std::max(1 - h.z * h.z, 1e-12), 0.5 / alpha);
      return fibres / (4 * std::max(wo.z + wi.z - wo.z * wi.z, 1e-4));
    });
  });
  return albedo;
}

double matte_albedo(double roughness, const AlbedoRow& past) {
  static const MatteSums sums = make_matte_sums();
  const double a = 1 / (1 + (0.5 - 2 / (3 * half_turn)) * roughness);
  const double mean = a * (1 + (2.0 / 3 - 28 / (15 * half_turn)) * roughness);
  const double plain = weighed(sums.plain, past), part = weighed(sums.part, past);
  double most = 0;
  for (int k = 0; k < (roughness == 0 ? 1 : matte_viewers); ++k) {
    double value = a * (plain + roughness * weighed(sums.both[static_cast<std::size_t>(k)], past));
    if (mean < 1)
      value += (1 - a * matte_part(matte_viewer(k).z, roughness)) * ((1 - a) * plain - a * roughness * part) /
               (1 - mean);
    most = std::max(most, value);
  }
  return std::max(most, 1e-3);
}

}  // namespace sundog
