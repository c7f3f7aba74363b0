// Measures a device's limits: bytes and operations a second, and the time of a launch.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "device/device.h"

namespace sundog {

/// A kernel of kernels/entry/peaks.cl at one vector width.
struct Peak {
  std::string what;       // "read memory", "copy memory", "read cache", "float", ..., "launch"
  std::string unit;       // "GB/s", "Gop/s" or "us"
  unsigned width = 1;     // lanes of a vector
  unsigned chains = 0;    // independent computations of a work-item; 0: none
  double amount = 0;      // bytes, operations or launches of a run; set before its first run counts
  std::size_t times = 0;  // launches or rounds of a run, enough to be measurable

  bool is_rate() const { return unit != "us"; }
};

class DevicePeaks {
 public:
  /// `megabytes`: size of the buffers, which should exceed every cache.
  DevicePeaks(DeviceInfo device, unsigned megabytes);

  /// Compares every run's result with the host's.
  void measure(const MeasureOptions& options);
  void add_to(Report& report) const;

  /// The greatest median of the peaks named `what`, over widths and chains; nothing if none was measured.
  std::optional<Spread> best(const std::string& what) const;

 private:
  struct Opened;
  struct Work;
  void add(Peak peak, double amount, const std::function<Work()>& make);
  void add_reads(const char* what, unsigned width, bool cached);
  void add_copies(unsigned width);
  void add_operations(const std::string& type, unsigned width, unsigned chains);
  void add_launches();
  std::optional<Spread> figure(std::size_t index) const;
  Table table() const;

  DeviceInfo info_;
  unsigned megabytes_;
  std::shared_ptr<Opened> opened_;
  std::vector<std::shared_ptr<Peak>> peaks_;
  std::vector<Subject> subjects_;  // one for each of peaks_
};

}  // namespace sundog
