// See samples.h.
#include "bench/report/samples.h"

#include <time.h>

#include <algorithm>

namespace sundog {

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

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace sundog
