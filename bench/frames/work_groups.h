// Times of a kernel for every sensible work-group size.
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

/// The sizes to try, of at most `limit` work-items: powers of two in one dimension, a prime (whose ranges are
/// padded), and with `two_dimensions` pairs of powers of two. Pure.
std::vector<WorkGroup> work_group_candidates(std::size_t limit, bool two_dimensions);

/// A kernel that can be run with any size and tells by a hash what came out.
struct TimedKernel {
  std::string scene, device, name;
  bool two_dimensions = false;
  std::size_t limit = 0;                        // work-items of a group
  std::vector<WorkGroup> sizes;                 // to try beside the default; empty: the candidates
  std::function<double(const WorkGroup&)> run;  // seconds
  std::function<std::uint64_t()> result;        // of the last run
  /// The group enqueued in the last run; zeros where the driver chose it (OpenCL does not report its choice).
  std::function<std::pair<std::size_t, std::size_t>()> local;
  /// Seconds that the last run's launches took by the host's clock beyond their device events. Nothing where
  /// the driver gives no times.
  std::function<std::optional<double>()> beyond_events;
  double build_seconds = 0;    // of the program, by the clock, before any run
  std::optional<bool> cached;  // whether it came from the binary cache
};

class WorkGroupTimes {
 public:
  /// `head` has the names and the sizes; measure() opens the kernel, whose limit decides what else is tried.
  WorkGroupTimes(TimedKernel head, std::function<TimedKernel()> open);

  /// All sizes in turn, then the one of the least median in turn with the default. A size whose result is not
  /// the default's to the bit, or that the driver refuses, has a problem. The default's own size stands once.
  void measure(const MeasureOptions& options);
  /// "best: 8x8, 0.84 of the default's time (...)" or "no clear winner: ...".
  std::string verdict() const;
  /// Adds the kernel's table, heat map and measurements.
  void add_to(Report& report) const;

  struct Way {
    WorkGroup group, enqueued;   // as asked for; the default's own size, else the one asked for
    std::string text;            // "8x8", "default (4x4)"
    std::vector<double> beyond;  // of each run, the first one too: seconds beyond the device's events
    /// Seconds that the driver compiled at the size's first launch: its time beyond the events, less that of
    /// a later launch. Nothing where the driver gives no times.
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
  std::vector<Subject> duel_;      // the default, and the size of the least median; or none
};

}  // namespace sundog
