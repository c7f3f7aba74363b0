// Times the current launch, so that another thread can detect a hanging driver.
#pragma once
#include <atomic>

namespace sundog {

/// The time limit of a launch in seconds: a hundred times the expected time, at least 30 s; 5 min for the
/// first launches of a kernel, in which a driver may compile. At least three times the longest launch so far:
/// on a busy machine llvmpipe took 67 s for a later launch, after a first one that compiled.
double launch_limit(double expected_seconds, bool first, double longest_seconds);

class LaunchWatch {
 public:
  /// `first`: this is the first launch of its kernel, in which a driver may compile.
  void begin(double limit_seconds, bool first);
  void end();
  /// Seconds since the launch began if it exceeds its limit, else 0. Thread-safe.
  double overdue() const;
  /// Seconds of the longest finished launch.
  double longest() const { return longest_; }
  /// Whether the current launch is a kernel's first.
  bool compiles() const { return started_ >= 0 && first_; }

 private:
  std::atomic<double> started_{-1}, limit_{0};  // seconds of the steady clock; negative: no launch
  std::atomic<double> longest_{0};
  std::atomic<bool> first_{false};
};

/// Marks a launch as running during its lifetime.
class WatchedLaunch {
 public:
  /// `limit` in seconds, if above 0, replaces launch_limit().
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
