// Measures the processor time of this process and of others during a timed run.
#pragma once
#include <deque>
#include <functional>
#include <string>

#include "base/clock.h"
#include "bench/report/samples.h"

namespace sundog {

class EnergyMeter;

/// Clock readings: wall-clock seconds since an arbitrary moment, and processor seconds so far.
struct ProcessorTimes {
  double wall = 0, own = 0;
  double all = -1;   // of all processes; below 0: unknown
  double clock = 0;  // MHz of the fastest core now; 0: unknown
};

/// The fastest core's MHz from cpufreq, which virtual machines lack; 0: unknown.
double core_clock(const std::string& folder = "/sys/devices/system/cpu");

/// From /proc/stat, which counts in hundredths of a second. Stolen time counts as used: the machine's host
/// took it.
ProcessorTimes processor_times();

class LoadMeter {
 public:
  /// `clock`: processor_times(), or a test's made-up times.
  explicit LoadMeter(unsigned cores, std::function<ProcessorTimes()> clock = processor_times);

  /// `energy`: gives the run its joules and the GPU's clock; it must live until end(). Null: they are
  /// unknown.
  void begin(EnergyMeter* energy = nullptr);
  /// The run since begin(), with the cores that it and other processes used. Others' cores are taken over at
  /// least the last half second, because the system's clock is coarse.
  Run end();
  /// A run is disturbed if other processes use more cores than this.
  double limit() const;

 private:
  unsigned cores_;
  std::function<ProcessorTimes()> clock_;
  std::deque<ProcessorTimes> before_;
  ProcessorTimes begun_, first_;
  EnergyMeter* energy_ = nullptr;
  double joules_ = -1;
};

}  // namespace sundog
