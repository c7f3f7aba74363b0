// How far a benchmark is: a bar with the time left on a terminal, else a line now and then.
#pragma once
#include <string>

#include "base/clock.h"

namespace sundog {

class BenchProgress {
 public:
  /// `expected`: seconds in all; 0: not known.
  BenchProgress(bool wanted, double expected) : wanted_(wanted), expected_(expected) {}
  ~BenchProgress() { erase(); }
  BenchProgress(const BenchProgress&) = delete;
  BenchProgress& operator=(const BenchProgress&) = delete;

  /// `done`: the part of the work that is over, from 0 to 1.
  void update(const std::string& step, double done);
  /// Takes the bar off the terminal.
  void erase();

 private:
  double seconds_left(double done) const;

  bool wanted_, drawn_ = false;
  double expected_, last_line_ = 0, last_drawn_ = 0;
  Stopwatch clock_;
};

}  // namespace sundog
