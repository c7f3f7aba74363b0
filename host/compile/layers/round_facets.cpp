// Interpolates isotropic facets by cubics through four table rows, uniform in the root of the width.
#include "compile/layers/round_facets.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sundog {
namespace {

constexpr std::size_t facets_size = sizeof(RoundFacets) / sizeof(float);

/// Four rows from `first` on, and their Lagrange weights.
struct RowsBetween {
  std::size_t first;
  std::array<double, 4> weights;
};

RowsBetween rows_at(double alpha) {
  const double least = std::sqrt(double(LEAST_LAYER_ALPHA));
  const double x = (std::sqrt(std::clamp(alpha, double(LEAST_LAYER_ALPHA), 1.0)) - least) / (1 - least) *
                   (round_widths - 1);
  const auto left = static_cast<std::size_t>(x);
  const std::size_t first = std::clamp(left, std::size_t{1}, round_widths - 3) - 1;
  const double t = x - double(first);
  return {first,
          {-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, -t * (t - 1) * (t - 3) / 2,
           t * (t - 1) * (t - 2) / 6}};
}

/// Interpolates `size` numbers between rows of a table.
void between(std::span<const float> table, std::size_t size, double alpha, float* to) {
  const RowsBetween rows = rows_at(alpha);
  const float* at = table.data() + rows.first * size;
  for (std::size_t i = 0; i < size; ++i)
    to[i] = float(rows.weights[0] * at[i] + rows.weights[1] * at[i + size] +
                  rows.weights[2] * at[i + 2 * size] + rows.weights[3] * at[i + 3 * size]);
}

}  // namespace

RoundFacets round_facets(double alpha) {
  std::array<float, facets_size> values;
  between(built_layer_tables().first(round_widths * facets_size), facets_size, alpha, values.data());
  return std::bit_cast<RoundFacets>(values);
}

FacetAlbedo albedo_of(const RoundFacets& facets, const Interface& interface) {
  FacetAlbedo albedo{};
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    double sum = 0;
    for (const FacetGroup& group : facets.groups[i]) {
      const double f = interface_reflects(std::clamp(double(group.cosine), 0.0, 1.0), interface);
      sum += f * (group.part + f * (double(facets.gains[i]) * group.gained - group.part));
    }
    albedo.of_interface[i] = std::max(sum, 0.0);
  }
  albedo.scale = 1 / std::max(1.0, double(facets.most));
  return albedo;
}

Facets::Facets(const FacetWidths& widths) : widths_(widths) {
  if (widths.x != widths.y) {
    gains_ = facet_gains(widths);
    return;
  }
  round_ = round_facets(widths.x);
  for (AlbedoRow& row : gains_) std::ranges::copy(round_->gains, row.begin());
}

FacetAlbedo Facets::albedo(const Interface& interface) const {
  return round_ ? albedo_of(*round_, interface) : facet_albedo(widths_, gains_, interface);
}

AlbedoRow fuzz_between(double alpha) {
  std::array<float, LAYER_STEPS> values;
  between(built_layer_tables().last(round_widths * LAYER_STEPS), LAYER_STEPS, alpha, values.data());
  AlbedoRow row;
  std::ranges::copy(values, row.begin());
  return row;
}

}  // namespace sundog
