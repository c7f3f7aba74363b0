// Medians, their intervals by order statistics, and the cost of an error by interpolation.
#include "bench/report/samples.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sundog {
namespace {

Spread spread_of(const std::vector<Run>& runs, double Run::* figure) {
  std::vector<double> values;
  for (const Run& run : runs)
    if (run.left_out.empty()) values.push_back(run.*figure);
  return spread(values);
}

double mean_of(const std::vector<Run>& runs, double Run::* figure) {
  const Spread all = spread_of(runs, figure);
  if (all.runs.empty() || all.min < 0) return -1;
  return std::accumulate(all.runs.begin(), all.runs.end(), 0.0) / static_cast<double>(all.runs.size());
}

}  // namespace

Spread spread(const std::vector<double>& runs) {
  if (runs.empty()) return {};
  std::vector<double> values = runs;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {median, values.front(), values.back(), runs};
}

Spread scaled(const Spread& spread, double factor) {
  Spread result{factor * spread.median, factor * spread.min, factor * spread.max, spread.runs};
  for (double& run : result.runs) run *= factor;
  return result;
}

Interval median_interval(const Spread& spread) {
  constexpr double beyond = 0.025;  // at each end
  std::vector<double> values = spread.runs;
  if (values.empty()) return {spread.min, spread.max};
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  std::size_t k = 0;  // runs outside at each end
  if (values.size() > 100) {
    k = static_cast<std::size_t>(0.5 * count - 0.98 * std::sqrt(count));
  } else {
    double term = std::pow(0.5, count), chance = term;  // that exactly k, or at most k, lie below the median
    for (;; ++k, chance += term) {
      term *= (count - static_cast<double>(k)) / static_cast<double>(k + 1);
      if (chance + term > beyond) break;
    }
  }
  return {values[k], values[values.size() - 1 - k]};
}

bool has_interval(const Spread& spread) { return spread.runs.size() > 1 || spread.min < spread.max; }

double half_width(const Spread& spread) {
  const Interval interval = median_interval(spread);
  return spread.median > 0 ? 0.5 * (interval.high - interval.low) / spread.median : 0;
}

double cost_of_error(const std::vector<ErrorCost>& measured, double error) {
  for (std::size_t i = 0; i + 1 < measured.size(); ++i) {
    const ErrorCost &a = measured[i], &b = measured[i + 1];
    if (!(a.error > 0) || !(b.error > 0) || error > a.error || error < b.error || a.error == b.error)
      continue;
    const double share = std::log(error / a.error) / std::log(b.error / a.error);
    return a.cost * std::pow(b.cost / a.cost, share);
  }
  return 0;
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Spread MeasuredWay::seconds() const { return spread_of(runs, &Run::seconds); }
Spread MeasuredWay::cores() const { return spread_of(runs, &Run::cores); }
Spread MeasuredWay::others() const { return spread_of(runs, &Run::others); }
double MeasuredWay::joules() const { return mean_of(runs, &Run::joules); }
double MeasuredWay::watts() const { return mean_of(runs, &Run::watts); }

}  // namespace sundog
