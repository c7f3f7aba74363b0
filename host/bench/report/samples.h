// Repeated measurements and what is quoted of them.
#pragma once
#include <vector>

namespace sundog {

/// Median and range of measurements; zeros when there are none.
struct Spread {
  double median = 0, min = 0, max = 0;
  std::vector<double> runs =
      {};  // all of them, in the order they were taken; empty for a figure made of others
};

Spread spread(const std::vector<double>& runs);

/// All of it times `factor`: seconds as milliseconds.
Spread scaled(const Spread& spread, double factor);

/// Seconds of processor time that this process has used, all threads together: on a machine that others use
/// too it says more than the wall clock.
double processor_seconds();

}  // namespace sundog
