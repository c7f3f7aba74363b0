// Times a kernel with every sensible work-group size.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "render/render.h"

namespace sundog {

/// The sizes to try, of at most `limit` work-items: the driver's choice, powers of two in one dimension, a
/// prime (whose ranges are padded), and with `two_dimensions` pairs of powers of two of up to 256 work-items.
/// Pure.
std::vector<WorkGroup> work_group_candidates(std::size_t limit, bool two_dimensions);

/// A kernel that can be run with any work-group size, and a hash of its result.
struct TimedKernel {
  std::string scene, device, name;
  std::vector<DeviceInfo> devices;  // the device, whose joules count
  bool two_dimensions = false;
  std::size_t limit = 0;                        // most work-items of a group
  std::vector<WorkGroup> sizes;                 // to try besides the default; empty: work_group_candidates()
  std::function<double(const WorkGroup&)> run;  // seconds
  std::function<std::uint64_t()> result;        // of the last run
  /// The group enqueued in the last run; zeros if the driver chose it (OpenCL does not report its choice).
  std::function<std::pair<std::size_t, std::size_t>()> local;
  /// How many seconds longer the last run's launches took by the host's clock than by device events. Nothing
  /// if the driver gives no times.
  std::function<std::optional<double>()> beyond_events;
  double build_seconds = 0;    // of building the program, by the host's clock, before any run
  std::optional<bool> cached;  // whether the program came from the binary cache
};

class WorkGroupTimes {
 public:
  /// `head` has the names and the sizes to try; measure() opens the kernel, whose limit determines the
  /// candidates.
  WorkGroupTimes(TimedKernel head, std::function<TimedKernel()> open);

  /// Times all sizes in turn, then the size with the least median in turn with the default. A size has a
  /// problem if its result differs from the default's in any bit or if the driver refuses it. The default's
  /// own size is timed once only.
  void measure(const MeasureOptions& options);
  /// "best: 8x8, 0.84 of the default's time (...)" or "no clear winner: ...".
  std::string verdict() const;
  /// Adds the kernel's bars, heat map, table and measurements.
  void add_to(Report& report) const;

  struct Way {
    WorkGroup group, enqueued;   // requested; enqueued (the default: its own size)
    std::string text;            // "8x8", "default (4x4)"
    std::vector<double> beyond;  // of each run, the first included: seconds beyond the device's events
    /// Seconds that the driver spent compiling at the size's first launch: its time beyond the device's
    /// events, less the median of the later launches. Nothing if the driver gives no times.
    std::optional<double> compile_seconds() const;
  };
  const std::vector<Subject>& subjects() const { return subjects_; }
  const std::vector<std::shared_ptr<Way>>& ways() const { return ways_; }

 private:
  void add_way(const WorkGroup& group, const std::string& text);
  const Subject* least() const;
  bool is_clear() const;
  const std::string& text_of(const Subject& subject) const;
  HeatMap heat_map() const;
  BarPlot bars() const;
  Table table() const;

  std::string name_;
  std::function<TimedKernel()> open_;
  TimedKernel kernel_;
  std::uint64_t expected_ = 0;  // the result of the default
  std::vector<std::shared_ptr<Way>> ways_;
  std::vector<Subject> subjects_;  // the default is the first
  std::vector<Subject> duel_;      // the default and the size with the least median, or empty
};

}  // namespace sundog
