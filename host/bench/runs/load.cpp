// See load.h.
#include "bench/runs/load.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace sundog {
namespace {

constexpr double least_window = 0.5;  // seconds
constexpr double tick = 0.01;         // of each core's count
constexpr double disturbing = 0.05;   // of the machine's cores

}  // namespace

ProcessorTimes processor_times() {
  static const Stopwatch clock;
  ProcessorTimes times{clock.seconds(), processor_seconds(), -1};
  std::ifstream in("/proc/stat");
  std::string name;
  // user, nice, system, idle, waiting for disks, two kinds of interrupts, stolen
  double counts[8] = {};
  if (!(in >> name) || name != "cpu") return times;
  for (double& count : counts)
    if (!(in >> count)) return times;
  const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
  times.all = (counts[0] + counts[1] + counts[2] + counts[5] + counts[6] + counts[7]) / ticks;
  return times;
}

LoadMeter::LoadMeter(unsigned cores, std::function<ProcessorTimes()> clock)
    : cores_(std::max(1u, cores)), clock_(std::move(clock)), first_(clock_()) {
  before_.push_back(first_);
}

void LoadMeter::begin() {
  begun_ = clock_();
  before_.push_back(begun_);
}

Run LoadMeter::end() {
  const ProcessorTimes now = clock_();
  Run run;
  run.at = begun_.wall - first_.wall;
  run.cores = (now.own - begun_.own) / std::max(1e-9, now.wall - begun_.wall);
  const double from = std::min(begun_.wall, now.wall - least_window);
  while (before_.size() > 1 && before_[1].wall <= from) before_.pop_front();
  const ProcessorTimes& start = before_.front();
  const double window = now.wall - start.wall;
  if (now.all >= 0 && window > 0)
    run.others = std::max(0.0, (now.all - start.all) - (now.own - start.own) - tick * cores_) / window;
  return run;
}

double LoadMeter::limit() const { return disturbing * cores_; }

}  // namespace sundog
