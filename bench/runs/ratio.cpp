// Ratios of paired runs, or of calls by bootstrap, each with its interval.
#include "bench/runs/ratio.h"

#include <algorithm>
#include <random>

namespace sundog {
namespace {

constexpr std::size_t resamples = 2000;  // of a bootstrap

std::vector<double> medians(const Calls& calls) {
  std::vector<double> all;
  for (const auto& runs : calls)
    if (!runs.empty()) all.push_back(spread(runs).median);
  return all;
}

double resampled_median(const std::vector<double>& values, std::mt19937& random) {
  std::vector<double> drawn;
  for (std::size_t i = 0; i < values.size(); ++i) drawn.push_back(values[random() % values.size()]);
  return spread(drawn).median;
}

std::vector<double> all_runs(const Calls& calls) {
  std::vector<double> all;
  for (const auto& runs : calls) all.insert(all.end(), runs.begin(), runs.end());
  return all;
}

/// The range of all runs, widened by high / low at both ends.
Interval wide_range(const std::vector<double>& runs) {
  const auto [low, high] = std::ranges::minmax(runs);
  return {low * low / high, high * high / low};
}

}  // namespace

const char* Ratio::verdict() const {
  return !is_known() || !is_enough || (low <= 1 && high >= 1) ? "not told apart"
         : high < 1                                           ? "faster"
                                                              : "slower";
}

Ratio paired_ratio(const std::vector<Run>& base, const std::vector<Run>& other) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(base.size(), other.size()); ++i)
    if (base[i].left_out.empty() && other[i].left_out.empty())
      ratios.push_back(other[i].seconds / base[i].seconds);
  if (ratios.empty()) return {};
  const Spread found = spread(ratios);
  const Interval interval = median_interval(found);
  return {found.median, interval.low, interval.high, ratios.size() >= fewest_for_interval};
}

Ratio ratio_of_calls(const Calls& base, const Calls& other) {
  const std::vector<double> a = medians(base), b = medians(other);
  if (a.empty() || b.empty()) return {};
  const double value = spread(b).median / spread(a).median;
  if (std::min(a.size(), b.size()) < fewest_for_interval) {
    const std::vector<double> of_base = all_runs(base), of_other = all_runs(other);
    const Interval range = wide_range(of_base), other_range = wide_range(of_other);
    return {value, other_range.low / range.high, other_range.high / range.low,
            std::min(of_base.size(), of_other.size()) >= fewest_for_interval};
  }
  std::mt19937 random;  // fixed seed: equal runs give equal intervals
  std::vector<double> ratios;
  for (std::size_t i = 0; i < resamples; ++i)
    ratios.push_back(resampled_median(b, random) / resampled_median(a, random));
  std::ranges::sort(ratios);
  return {value, ratios[resamples / 40], ratios[resamples - 1 - resamples / 40]};
}

}  // namespace sundog
