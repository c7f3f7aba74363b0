// Searches a grid with ordered axes for its fastest point: coarse to fine, one axis at a time, within a time
// budget. It needs no device, so tests use made-up timings.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace sundog {

/// The default and the best point, run again in pairs.
struct TunePairs {
  double usual = 0, best = 0;  // median seconds
  int wins = 0, pairs = 0;     // of `best`

  /// Whether `best` takes 2 % less time and won more pairs than by chance: 15 of 20, which a fair coin
  /// reaches once in fifty times.
  bool confirm() const;
};

/// An index for each axis.
using TunePoint = std::vector<std::size_t>;

struct TuneProblem {
  std::vector<std::size_t> axes;  // number of values of each axis
  TunePoint start;                // the default
  /// Seconds of a point; nothing: the device refuses it, or its result is wrong.
  std::function<std::optional<double>(const TunePoint&)> measure;
  /// Measures the default and the winner again, in turn.
  std::function<TunePairs(const TunePoint& usual, const TunePoint& best)> measure_again;
  /// Whether there is time to measure a point, and to measure the winner again after it.
  std::function<bool(const TunePoint&)> affordable;
};

struct TuneResult {
  TunePoint best;  // the default, unless pairs confirm another
  double default_seconds = 0, best_seconds = 0;
  std::size_t tried = 0, rejected = 0;
  std::size_t left_out = 0;  // not affordable
};

/// A point must be 2 % faster than the best so far to take its place. Each point is measured once.
TuneResult search_tuning(const TuneProblem& problem);

}  // namespace sundog
