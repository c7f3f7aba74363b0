// How long the launch in hand has been running, for another thread to see whether the driver hangs.
#pragma once
#include <atomic>

namespace sundog {

/// The limit of a launch that is expected to take so long: a hundred times that, at least 30 s; 5 min for the
/// first launches of a kernel, in which a driver may compile. SUNDOG_LAUNCH_LIMIT (seconds) replaces all.
double launch_limit(double expected_seconds, bool first);

class LaunchWatch {
 public:
  void begin(double limit_seconds);
  void end();
  /// Seconds that the launch has taken when it is over its limit, else 0. Any thread may ask.
  double overdue() const;

 private:
  std::atomic<double> started_{-1}, limit_{0};  // seconds of the steady clock; negative: no launch
};

/// While it lives, a launch runs.
class WatchedLaunch {
 public:
  WatchedLaunch(LaunchWatch& watch, double limit_seconds) : watch_(watch) { watch_.begin(limit_seconds); }
  ~WatchedLaunch() { watch_.end(); }
  WatchedLaunch(const WatchedLaunch&) = delete;
  WatchedLaunch& operator=(const WatchedLaunch&) = delete;

 private:
  LaunchWatch& watch_;
};

}  // namespace sundog
