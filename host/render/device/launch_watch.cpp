// Times launches, and sets the time after which a launch counts as hung from its expected and longest times.
#include "render/device/launch_watch.h"

#include <algorithm>
#include <chrono>

namespace sundog {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

double launch_limit(double expected_seconds, bool first, double longest_seconds) {
  constexpr double least = 30, compiling = 300, patience = 100, again = 3;
  return std::max(first ? compiling : std::max(least, patience * expected_seconds), again * longest_seconds);
}

void LaunchWatch::begin(double limit_seconds, bool first) {
  limit_ = limit_seconds;
  first_ = first;
  started_ = now();
}

void LaunchWatch::end() {
  longest_ = std::max<double>(longest_, now() - started_);
  started_ = -1;
}

double LaunchWatch::overdue() const {
  const double started = started_, seconds = now() - started;
  return started >= 0 && seconds > limit_ ? seconds : 0;
}

}  // namespace sundog
