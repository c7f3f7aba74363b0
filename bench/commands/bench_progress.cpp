// Draws a bar on a terminal, or writes a line every ten seconds.
#include "bench/commands/bench_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/process/progress.h"
#include "app/process/warnings.h"

namespace sundog {
namespace {

constexpr double seconds_between_lines = 10, seconds_between_drawings = 0.1;

}  // namespace

/// Blends from the estimate towards the measured rate as the work proceeds.
double BenchProgress::seconds_left(double done) const {
  const double by_clock = done > 0 ? clock_.seconds() / done * (1 - done) : 0;
  return done * by_clock + (1 - done) * (expected_ > 0 ? expected_ * (1 - done) : by_clock);
}

void BenchProgress::update(const std::string& step, double done) {
  if (!wanted_) return;
  done = std::clamp(done, 0.0, 1.0);
  const double now = clock_.seconds();
  if (drawn_ && now - last_drawn_ < seconds_between_drawings) return;
  const std::string text =
      fmt::format("{:3.0f} %, about {} left: {}", 100 * done, duration_text(seconds_left(done)), step);
  if (stderr_is_terminal()) {
    tell(fmt::format("\r{}\033[K", bar_line(done, " " + text, terminal_columns())));
    drawn_ = true;
    last_drawn_ = now;
  } else if (now - last_line_ >= seconds_between_lines) {
    tell(fmt::format("sundog: {}\n", text.substr(text.find_first_not_of(' '))));
    last_line_ = now;
  }
  std::fflush(stderr);
}

void BenchProgress::erase() {
  if (drawn_) tell("\r\033[K");
  drawn_ = false;
}

}  // namespace sundog
