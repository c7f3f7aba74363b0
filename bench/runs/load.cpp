// Reads /proc/stat and cpufreq, and finds the cores that other processes used during a run.
#include "bench/runs/load.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "device/energy.h"

namespace sundog {
namespace {

constexpr double least_window = 0.5;  // seconds
constexpr double tick = 0.01;         // precision of each core's count, in seconds
constexpr double disturbing = 0.05;   // of the machine's cores

}  // namespace

double core_clock(const std::string& folder) {
  double most = 0;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    std::ifstream in(entry.path() / "cpufreq/scaling_cur_freq");
    double kilohertz = 0;
    if (in >> kilohertz) most = std::max(most, 1e-3 * kilohertz);
  }
  return most;
}

ProcessorTimes processor_times() {
  static const Stopwatch clock;
  ProcessorTimes times{clock.seconds(), processor_seconds(), -1, core_clock()};
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

void LoadMeter::begin(EnergyMeter* energy) {
  energy_ = energy;
  begun_ = clock_();
  before_.push_back(begun_);
  if (energy_) joules_ = energy_->joules();
}

Run LoadMeter::end() {
  const ProcessorTimes now = clock_();
  Run run;
  run.at = begun_.wall - first_.wall;
  run.clock = now.clock;
  const double wall = std::max(1e-9, now.wall - begun_.wall);
  if (energy_) {
    const double joules = energy_->joules();
    if (joules >= 0 && joules_ >= 0) run.joules = joules - joules_, run.watts = run.joules / wall;
    if (energy_->clock() > 0) run.clock = energy_->clock();
  }
  run.cores = (now.own - begun_.own) / wall;
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
