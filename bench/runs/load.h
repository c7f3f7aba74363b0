// Measures the processor time of this process and of others during a timed run.
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "base/clock.h"
#include "bench/report/samples.h"

namespace sundog {

class EnergyMeter;

/// Seconds since some moment, and processor seconds until then.
struct ProcessorTimes {
  double wall = 0, own = 0;
  double all = -1;   // of all processes; below 0: unknown
  double clock = 0;  // MHz of the fastest core now; 0: unknown
};

/// By cpufreq, which a virtual machine has not; 0: unknown.
double core_clock(const std::string& folder = "/sys/devices/system/cpu");

/// By /proc/stat, which counts in hundredths of a second. Stolen time counts: the machine's host took it.
ProcessorTimes processor_times();

class LoadMeter {
 public:
  /// `clock`: processor_times(), or made-up times of a test.
  explicit LoadMeter(unsigned cores, std::function<ProcessorTimes()> clock = processor_times);

  void begin();
  /// The run since begin(): its cores, and the cores that others had. A short run is judged together with the
  /// half second before its end, because the system's clock is coarse.
  Run end();
  /// Runs have joules from now on, and the clock of the GPU.
  void count(std::shared_ptr<EnergyMeter> energy) { energy_ = std::move(energy); }
  /// From how many cores of others on a run is disturbed.
  double limit() const;

 private:
  unsigned cores_;
  std::function<ProcessorTimes()> clock_;
  std::deque<ProcessorTimes> before_;
  ProcessorTimes begun_, first_;
  std::shared_ptr<EnergyMeter> energy_;
  double joules_ = -1;
};

}  // namespace sundog
