// How long a process that should say again and again that it lives has said nothing: what is stopped, or
// swapped out, keeps its channel open and cannot be told from one that works otherwise.
#pragma once
#include <algorithm>

#include "base/clock.h"

namespace sundog {

/// So often a process that serves devices says that it is there (Message::alive).
inline constexpr double beat_seconds = 0.25;

/// Counts only time in which this side listened: after both were stopped (Ctrl-Z, a sleeping machine), none
/// has passed.
class Silence {
 public:
  void heard() {
    seconds_ = 0;
    since_ = Stopwatch();
  }
  /// To be called at least twice a second while it listens.
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
