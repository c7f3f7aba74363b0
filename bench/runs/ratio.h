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
  /// Of the other way: "faster", "slower" or "not told apart".
  const char* verdict() const;
};

/// Of ways that took turns: runs with the same place in the order make a pair, a run that was left out takes
/// its pair along. The interval is that of the median of the pairs' ratios; six pairs are the fewest for a
/// verdict.
Ratio paired_ratio(const std::vector<Run>& base, const std::vector<Run>& other);

/// Runs of a call of the program.
using Calls = std::vector<std::vector<double>>;

/// Of ways that were measured in calls of their own. Calls differ by more than the runs within one do (by
/// where the memory lies, and the machine's state), so six or more of each are taken as a sample: the
/// interval is by bootstrap of the medians of their medians (Efron and Tibshirani, "An Introduction to the
/// Bootstrap", 1993, chapter 13). With fewer it is that of the ranges of all runs, each widened by its width
/// at both ends; six runs are the fewest for a verdict.
Ratio ratio_of_calls(const Calls& base, const Calls& other);

}  // namespace sundog
