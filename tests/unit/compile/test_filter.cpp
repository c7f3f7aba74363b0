// Reconstruction filters: the table that samples are placed by has the filter's moments and its sign.
#include "compile/view/filter.h"

#include <cmath>

#include "catch.h"
#include "scene/kinds.h"
#include "shared/filter.h"

using namespace sundog;

namespace {

/// The mean of |x|^power over the part of the table that begins at `first`: equal shares, even in between.
double moment(const std::vector<float>& table, int first, int power) {
  double sum = 0;
  for (int k = 0; k < FILTER_STEPS; ++k) {
    const double a = table[static_cast<std::size_t>(first + k)],
                 b = table[static_cast<std::size_t>(first + k + 1)];
    constexpr int steps = 8;
    for (int i = 0; i < steps; ++i) sum += std::pow(a + (b - a) * (i + 0.5) / steps, power);
  }
  return sum / FILTER_STEPS / 8;
}

RenderSettings with_filter(Filter filter, double radius = 0) {
  RenderSettings settings;
  settings.filter = filter;
  settings.filter_radius = radius;
  return settings;
}

}  // namespace

TEST_CASE(
    "a filter's table has its moments, its lobes below zero among them, so that weights integrate to one") {
  for (std::size_t f = 0; f < filters.size(); ++f)
    for (const double radius : {0.0, 1.25}) {
      const RenderSettings settings = with_filter(filters[f].value, radius);
      const std::vector<float> table = filter_table(settings);
      INFO(filters[f].name << " " << radius);
      if (filters[f].value == Filter::box && radius == 0) {
        CHECK(table.empty());
        continue;
      }
      REQUIRE(table.size() == FILTER_TABLE);
      const double reach = radius > 0 ? radius : filters[f].radius, below = table[0];
      CHECK(filter_radius(settings) == reach);
      CHECK(table[FILTER_ABOVE + FILTER_STEPS] <= reach * 1.001);
      // The filter's moments: means of |x|, x^2 and so on. In its long tails the table has few steps.
      constexpr int steps = 200'000;
      double whole = 0, expected[5] = {};
      for (int i = 0; i < steps; ++i) {
        const double x = reach * (i + 0.5) / steps, value = filter_value(settings.filter, reach, x);
        whole += value;
        for (int power = 1; power < 5; ++power) expected[power] += value * std::pow(x, power);
      }
      for (int power = 1; power < 5; ++power) {
        const double made =
            ((1 - below) * moment(table, FILTER_ABOVE, power) - below * moment(table, FILTER_BELOW, power)) /
            (1 - 2 * below);
        CHECK(made == Approx(expected[power] / whole).epsilon(0.005 * power * power).margin(1e-3));
      }
    }
}

TEST_CASE("only Mitchell's filter has lobes below zero") {
  CHECK(filter_table(with_filter(Filter::mitchell))[0] > 0.02);
  for (const Filter filter : {Filter::tent, Filter::gaussian, Filter::blackman_harris})
    CHECK(filter_table(with_filter(filter))[0] < 1e-9);
}
