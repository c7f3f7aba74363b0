// Repeated measurements: raw runs, and the statistics quoted from them.
#pragma once
#include <exception>
#include <string>
#include <vector>

namespace sundog {

/// Median and range of measurements; zeros if there are none.
struct Spread {
  double median = 0, min = 0, max = 0;
  std::vector<double> runs = {};  // in the order they were taken; empty for a derived figure
};

Spread spread(const std::vector<double>& runs);

/// Every value times `factor`, e.g. seconds in milliseconds.
Spread scaled(const Spread& spread, double factor);

/// Bounds that contain the median with 95 % confidence for any distribution, by order statistics (Le Boudec,
/// "Performance Evaluation of Computer and Communication Systems", 2010, theorem 2.1); the range if there are
/// fewer than six runs.
struct Interval {
  double low = 0, high = 0;
};
Interval median_interval(const Spread& spread);
constexpr std::size_t fewest_for_interval = 6;

/// Whether the spread has an interval. A single run has none, nor has an exact figure, such as a base's ratio
/// to itself.
bool has_interval(const Spread& spread);

/// Half of the interval divided by the median: 0.03 is "±3 %".
double half_width(const Spread& spread);

/// The error of a way with some number of samples, and its cost in seconds or rays.
struct ErrorCost {
  double error = 0, cost = 0;
};

/// The cost of reaching `error`, interpolated between two neighbours of `measured` as a power of the error; 0
/// if `error` lies outside of them.
double cost_of_error(const std::vector<ErrorCost>& measured, double error);

/// Seconds of processor time that this process has used, all threads together.
double processor_seconds();

/// One timed run.
struct Run {
  double seconds = 0;
  double cores = 0;         // used by this process: processor seconds per wall-clock second
  double others = -1;       // cores used by other processes meanwhile; below 0: unknown
  double at = 0;            // seconds since the bench began
  std::string left_out;     // why it does not count: "busy", "slow clock" or "wrong result"; empty: it counts
  double clock = 0;         // MHz at its end, of the fastest core or of the GPU; 0: unknown
  double joules = -1;       // that the row's devices used; below 0: unknown
  double watts = -1;        // the same by the wall-clock seconds in which they were counted
  std::string disturbed{};  // why it was left out before it counted for lack of quiet runs; empty: it was not
};

/// One way of doing the work that a bench times: a row of its table.
struct MeasuredWay {
  std::string name;  // unique within the bench
  std::vector<Run> runs;
  std::size_t known = 0;         // number of first runs from an earlier report
  std::string problem;           // why no time counts; empty: none
  std::exception_ptr failure{};  // the exception behind the problem; null: a wrong result
  bool once = false;             // its first run counts and is the only one
  bool cold = false;             // has no warm-up: its first run counts
  bool noisy = false;            // too few runs were quiet: the least disturbed of the others count too

  bool is_good() const { return problem.empty() && !seconds().runs.empty(); }
  /// Seconds of the runs that count.
  Spread seconds() const;
  /// The entries of `figures` whose runs count. `figures` has one for the warm-up, if there is one, then one
  /// for each run.
  template <class T>
  std::vector<T> counted(const std::vector<T>& figures) const {
    std::vector<T> all;
    const std::size_t first = cold ? 0 : 1;
    for (std::size_t i = known; i < runs.size(); ++i)
      if (runs[i].left_out.empty() && i - known + first < figures.size())
        all.push_back(figures[i - known + first]);
    return all;
  }
  Spread cores() const;
  Spread others() const;
  /// Means of the runs, as counters are too coarse for a short run. Below 0: unknown.
  double joules() const;
  double watts() const;
};

}  // namespace sundog
