// Repeated measurements: raw runs, and what is quoted of them.
#pragma once
#include <exception>
#include <string>
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

/// Bounds that hold the median with 95 % confidence whatever the distribution, by order statistics (Le
/// Boudec, "Performance Evaluation of Computer and Communication Systems", 2010, theorem 2.1); the range
/// where there are fewer than six runs.
struct Interval {
  double low = 0, high = 0;
};
Interval median_interval(const Spread& spread);
constexpr std::size_t fewest_for_interval = 6;

/// Whether it has one: neither a single run nor a figure that is exact, as a base's ratio to itself.
bool has_interval(const Spread& spread);

/// Half of the interval over the median: 0.03 is "±3 %".
double half_width(const Spread& spread);

/// A way with so many samples: its error, and what it costs in seconds or rays.
struct ErrorCost {
  double error = 0, cost = 0;
};

/// The cost of reaching `error`, between two neighbours of `measured` as a power of the error; 0: none was
/// measured on one of its sides.
double cost_of_error(const std::vector<ErrorCost>& measured, double error);

/// Seconds of processor time that this process has used, all threads together.
double processor_seconds();

/// One timed run.
struct Run {
  double seconds = 0;
  double cores = 0;      // that this process had: processor seconds by wall second
  double others = -1;    // cores that other processes had meanwhile; below 0: unknown
  double at = 0;         // seconds since the bench began
  std::string left_out;  // why it does not count: "busy", "slow clock" or "wrong result"; empty: it counts
  double clock = 0;      // MHz at its end, of the fastest core or of the GPU; 0: unknown
  double joules = -1;    // that the devices used; below 0: unknown
};

/// One way of doing the work that a bench times: a row of its table.
struct MeasuredWay {
  std::string name;  // unlike any other of the bench
  std::vector<Run> runs;
  std::size_t known = 0;         // the first of them, that an earlier report had
  std::string problem;           // not empty: no time counts, and why
  std::exception_ptr failure{};  // what the problem was thrown as; null: a wrong result
  bool once = false;             // its first run counts, and there is no other
  bool noisy = false;  // too few quiet runs could be had: the least disturbed of the others count too

  bool is_good() const { return problem.empty() && !seconds().runs.empty(); }
  /// Seconds of the runs that count.
  Spread seconds() const;
  /// Those of `figures`, one for each run and the first for the warm-up, whose runs count.
  template <class T>
  std::vector<T> counted(const std::vector<T>& figures) const {
    std::vector<T> all;
    for (std::size_t i = known; i < runs.size(); ++i)
      if (runs[i].left_out.empty() && i - known + 1 < figures.size()) all.push_back(figures[i - known + 1]);
    return all;
  }
  Spread cores() const;
  Spread others() const;
  /// Joules a run, in the mean: counters are too coarse for a short one. Below 0: unknown.
  double joules() const;
};

}  // namespace sundog
