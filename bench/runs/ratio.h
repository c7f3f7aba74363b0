// Compares the times of two ways of doing work, from the runs of both.
#pragma once
#include <vector>

#include "bench/report/samples.h"

namespace sundog {

/// Another way's time divided by the base's, with bounds that contain it with 95 % confidence.
struct Ratio {
  double value = 0, low = 0, high = 0;
  bool is_enough = true;  // enough runs for a 95 % interval, and so for a verdict

  bool is_known() const { return value > 0; }
  /// Whether the other way is "faster", "slower" or "not told apart".
  const char* verdict() const;
};

/// The ratio of ways that took turns. The i-th runs of both make a pair; a left-out run removes its pair. The
/// interval holds the median of the pairs' ratios; a verdict needs six pairs.
Ratio paired_ratio(const std::vector<Run>& base, const std::vector<Run>& other);

/// Seconds of the runs, for each call of the program.
using Calls = std::vector<std::vector<double>>;

/// The ratio of ways that were measured in separate calls. Calls differ more than the runs within one (memory
/// layout, the machine's state), so six or more of each are the sample: the interval is a bootstrap of the
/// medians of their medians (Efron and Tibshirani, "An Introduction to the Bootstrap", 1993, chapter 13).
/// With fewer calls it is the ratio of the ranges of all runs, each widened by its own width (as a factor) at
/// both ends; a verdict needs six runs.
Ratio ratio_of_calls(const Calls& base, const Calls& other);

}  // namespace sundog
