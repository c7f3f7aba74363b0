// Measures the silence of a process that should send heartbeats: a stopped or swapped-out process keeps its
// channel open and cannot be detected otherwise.
#pragma once
#include <algorithm>

#include "base/clock.h"

namespace sundog {

/// Heartbeat interval (Message::alive) of a process with device workers.
inline constexpr double beat_seconds = 0.25;

/// Counts only time in which this side listened; suspending both sides (Ctrl-Z, a sleeping machine) therefore
/// counts nothing.
class Silence {
 public:
  void heard() {
    seconds_ = 0;
    since_ = Stopwatch();
  }
  /// Call at least twice a second while listening.
  double seconds() {
    seconds_ += std::min(since_.seconds(), 0.5);
    since_ = Stopwatch();
    return seconds_;
  }

 private:
  double seconds_ = 0;
  Stopwatch since_;
};

}  // namespace sundog
