// The search for the fastest point of a grid whose axes are ordered: coarse to fine, one axis at a time,
// within a time budget. Knows no device, so it is tested on made-up timings.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace sundog {

/// Two points run again in pairs.
struct TunePairs {
  double usual = 0, best = 0;  // median seconds
  int wins = 0, pairs = 0;     // of `best`

  /// `best` takes 2 % less time and won by more than chance: 15 of 20 pairs, as only one fair coin in fifty
  /// does.
  bool confirm() const;
};

/// An index for each axis.
using TunePoint = std::vector<std::size_t>;

struct TuneProblem {
  std::vector<std::size_t> axes;  // how many values each has
  TunePoint start;                // the default
  /// Seconds of a point; nothing: it is refused, or its result is wrong.
  std::function<std::optional<double>(const TunePoint&)> measure;
  /// The default and what won, measured again in turn.
  std::function<TunePairs(const TunePoint& usual, const TunePoint& best)> measure_again;
  /// Whether there is time to measure a point, and to measure the winner again after it.
  std::function<bool(const TunePoint&)> affordable;
};

struct TuneResult {
  TunePoint best;  // the default, when pairs confirm nothing else
  double default_seconds = 0, best_seconds = 0;
  std::size_t tried = 0, rejected = 0;
  std::size_t left_out = 0;  // not affordable
};

/// A point must be 2 % faster than the best so far to take its place. Each point is measured once.
TuneResult search_tuning(const TuneProblem& problem);

}  // namespace sundog
