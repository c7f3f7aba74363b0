// Shows a benchmark's progress on stderr: a bar with the time left on a terminal, otherwise a line every ten
// seconds.
#pragma once
#include <string>

#include "base/clock.h"

namespace sundog {

class BenchProgress {
 public:
  /// `expected`: estimated total seconds; 0: unknown.
  BenchProgress(bool wanted, double expected) : wanted_(wanted), expected_(expected) {}
  ~BenchProgress() { erase(); }
  BenchProgress(const BenchProgress&) = delete;
  BenchProgress& operator=(const BenchProgress&) = delete;

  /// `done`: the fraction of the work that is completed, from 0 to 1.
  void update(const std::string& step, double done);
  /// Removes the bar from the terminal.
  void erase();

 private:
  double seconds_left(double done) const;

  bool wanted_, drawn_ = false;
  double expected_, last_line_ = 0, last_drawn_ = 0;
  Stopwatch clock_;
};

}  // namespace sundog
