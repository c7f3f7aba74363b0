// Whether one way of doing work takes less time than another, from the runs of both.
#pragma once
#include <vector>

#include "bench/report/samples.h"

namespace sundog {

/// How many times the time of `base` another way takes, with bounds that hold it with 95 % confidence.
struct Ratio {
  double value = 0, low = 0, high = 0;
  bool is_enough = true;  // runs for an interval of 95 %, and so for a verdict

  bool is_known() const { return value > 0; }
  /// Whether the other way is "faster", "slower" or "not told apart".
  const char* verdict() const;
};

/// The ratio of ways that took turns. Runs at the same place in the order make a pair; a run that was left
/// out removes its pair. The interval is that of the median of the pairs' ratios; a verdict needs six pairs.
Ratio paired_ratio(const std::vector<Run>& base, const std::vector<Run>& other);

/// Runs of a call of the program.
using Calls = std::vector<std::vector<double>>;

/// The ratio of ways that were measured in separate calls. Calls differ by more than the runs within one (by
/// memory layout and the machine's state), so six or more of each are taken as a sample: the interval is by
/// bootstrap of the medians of their medians (Efron and Tibshirani, "An Introduction to the Bootstrap", 1993,
/// chapter 13). With fewer it is that of the ranges of all runs, each widened by its width at both ends; a
/// verdict needs six runs.
Ratio ratio_of_calls(const Calls& base, const Calls& other);

}  // namespace sundog
