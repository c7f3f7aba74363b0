// How long a process that should say again and again that it lives has said nothing: what is stopped, or
// swapped out, keeps its channel open and cannot be told from one that works otherwise.
#pragma once
#include <algorithm>
#include <cstdlib>

#include "base/clock.h"

namespace sundog {

/// So often a process that serves devices says that it is there (Message::alive).
inline constexpr double beat_seconds = 0.25;

/// After so many seconds of silence a process is given up: 10, or what the variable SUNDOG_SILENCE_LIMIT
/// says.
inline double silence_limit() {
  const char* text = std::getenv("SUNDOG_SILENCE_LIMIT");
  const double seconds = text ? std::strtod(text, nullptr) : 0;
  return seconds > 0 ? seconds : 10;
}

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
