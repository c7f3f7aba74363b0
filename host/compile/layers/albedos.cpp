// See albedos.h. The lobes are those of kernels/lib/shade/layer_lobes.cl.
#include "compile/layers/albedos.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sundog {
namespace {

using glm::dvec3;

constexpr double half_turn = std::numbers::pi;

double matte_part(double c, double roughness) {
  const double d = 1 - c;
  return 1 + roughness * d * (0.0571085289 + d * (0.491881867 + d * (-0.332181442 + d * 0.0714429953)));
}

/// A white matte ground's value times pi.
double matte(const dvec3& wo, const dvec3& wi, double roughness) {
  const double a = 1 / (1 + (0.5 - 2 / (3 * half_turn)) * roughness);
  const double mean = a * (1 + (2.0 / 3 - 28 / (15 * half_turn)) * roughness);
  const double s = wo.x * wi.x + wo.y * wi.y;
  const double single = a * (1 + roughness * (s > 0 ? s / std::max(wo.z, wi.z) : s));
  if (mean >= 1) return single;
  return single + (1 - a * matte_part(wo.z, roughness)) * (1 - a * matte_part(wi.z, roughness)) / (1 - mean);
}

/// The sum over directions, by cosine and turn, of `value(wi)` times the cosine's share of the hemisphere.
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
  double most = 0;
  for (int k = 0; k < (roughness == 0 ? 1 : 12); ++k) {
    const dvec3 wo = viewer(std::max(k / 11.0, 0.01), 0);
    most = std::max(most, over_hemisphere(32, 48, [&](const dvec3& wi) {
                      return matte(wo, wi, roughness) * at_cosine(past, wi.z);
                    }));
  }
  return std::max(most, 1e-3);
}

}  // namespace sundog
