// Integrates the filter in 2^14 steps and inverts the sum to distances at equal quantiles, separately for its
// positive and negative parts.
#include "compile/view/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/kinds.h"
#include "shared/filter.h"

namespace sundog {
namespace {

/// Mitchell and Netravali 1988 with B = C = 1/3; radius 2.
double mitchell(double x) {
  if (x < 1) return (7 * x * x * x - 12 * x * x + 16.0 / 3) / 6;
  return (-7.0 / 3 * x * x * x + 12 * x * x - 20 * x + 32.0 / 3) / 6;
}

/// Radius 1 (Harris 1978, four terms).
double blackman_harris(double x) {
  const double angle = std::numbers::pi * x;
  return 0.35875 + 0.48829 * std::cos(angle) + 0.14128 * std::cos(2 * angle) + 0.01168 * std::cos(3 * angle);
}

/// Radius 1, standard deviation 1/3, lowered to end at 0.
double gaussian(double x) { return std::exp(-4.5 * x * x) - std::exp(-4.5); }

/// Writes FILTER_STEPS + 1 distances at equal quantiles of the filter's part of one sign. Returns the part's
/// area.
double add_distances(Filter filter, double radius, double sign, float* distances) {
  constexpr int steps = 1 << 14;
  std::vector<double> area(steps + 1);  // from the centre to step i
  for (int i = 0; i < steps; ++i)
    area[static_cast<std::size_t>(i) + 1] =
        area[static_cast<std::size_t>(i)] +
        std::max(0.0, sign * filter_value(filter, radius, radius * (i + 0.5) / steps)) * radius / steps;
  const auto end = std::find_if(area.begin(), area.end(), [&](double a) { return a == area.back(); });
  for (int k = 0; k <= FILTER_STEPS; ++k) {
    const double wanted = area.back() * k / FILTER_STEPS;
    auto above = std::upper_bound(area.begin(), area.end(), wanted);
    if (above > end) above = end;
    if (above == area.begin()) continue;  // the filter has no such part
    const auto below = above - 1;
    const double share = *above > *below ? (wanted - *below) / (*above - *below) : 0;
    distances[k] = static_cast<float>(radius * (static_cast<double>(below - area.begin()) + share) / steps);
  }
  return area.back();
}

}  // namespace

double filter_value(Filter filter, double radius, double x) {
  const double u = std::abs(x) / radius;
  if (u > 1) return 0;
  switch (filter) {
    case Filter::box:
      return 1;
    case Filter::tent:
      return 1 - u;
    case Filter::gaussian:
      return gaussian(u);
    case Filter::blackman_harris:
      return blackman_harris(u);
    case Filter::mitchell:
      return mitchell(2 * u);
  }
  return 0;
}

double filter_radius(const RenderSettings& settings) {
  if (settings.filter_radius > 0) return settings.filter_radius;
  return std::ranges::find(filters, settings.filter, &FilterFacts::value)->radius;
}

std::vector<float> filter_table(const RenderSettings& settings) {
  const double radius = filter_radius(settings);
  if (settings.filter == Filter::box && radius == 0.5) return {};
  std::vector<float> table(FILTER_TABLE);
  const double above = add_distances(settings.filter, radius, 1, table.data() + FILTER_ABOVE);
  const double below = add_distances(settings.filter, radius, -1, table.data() + FILTER_BELOW);
  table[0] = static_cast<float>(below / (above + below));
  return table;
}

}  // namespace sundog
