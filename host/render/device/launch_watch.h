// How long the launch in hand has been running, for another thread to see whether the driver hangs.
#pragma once
#include <atomic>

namespace sundog {

/// The limit of a launch that is expected to take so long: a hundred times that, at least 30 s; 5 min for the
/// first launches of a kernel, in which a driver may compile. At least three times the longest launch so far:
/// on a busy machine llvmpipe has taken 67 s for a later launch, after a first one that compiled.
double launch_limit(double expected_seconds, bool first, double longest_seconds);

class LaunchWatch {
 public:
  /// `first`: of its kernel, in which a driver may compile.
  void begin(double limit_seconds, bool first);
  void end();
  /// Seconds that the launch has taken when it is over its limit, else 0. Any thread may ask.
  double overdue() const;
  /// Seconds of the longest launch that has ended.
  double longest() const { return longest_; }
  /// Whether the launch in hand is a kernel's first.
  bool compiles() const { return started_ >= 0 && first_; }

 private:
  std::atomic<double> started_{-1}, limit_{0};  // seconds of the steady clock; negative: no launch
  std::atomic<double> longest_{0};
  std::atomic<bool> first_{false};
};

/// While it lives, a launch runs.
class WatchedLaunch {
 public:
  /// `limit` in seconds takes the place of launch_limit(); 0: none.
  WatchedLaunch(LaunchWatch& watch, double expected_seconds, bool first, double limit) : watch_(watch) {
    watch_.begin(limit > 0 ? limit : launch_limit(expected_seconds, first, watch.longest()), first);
  }
  ~WatchedLaunch() { watch_.end(); }
  WatchedLaunch(const WatchedLaunch&) = delete;
  WatchedLaunch& operator=(const WatchedLaunch&) = delete;

 private:
  LaunchWatch& watch_;
};

}  // namespace sundog
