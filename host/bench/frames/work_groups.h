// Times of a kernel for every sensible work-group size.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/report/report.h"
#include "render/render.h"

namespace sundog {

/// The sizes to try, of at most `limit` work-items: sundog's default first, the driver's own choice, powers
/// of two in one dimension, a prime (whose ranges are padded), and with `two_dimensions` pairs of powers of
/// two. Pure.
std::vector<WorkGroup> work_group_candidates(std::size_t limit, bool two_dimensions);

/// A kernel that can be run with any size and tells by a hash what came out.
struct TimedKernel {
  std::string scene, device, name;
  bool two_dimensions = false;
  std::size_t limit = 0;                        // work-items of a group
  std::function<double(const WorkGroup&)> run;  // seconds
  std::function<std::uint64_t()> result;        // of the last run
  /// Of the last run: seconds that launches took by the host's clock beyond what the device's events say that
  /// kernels ran. Nothing where the driver gives no times.
  std::function<std::optional<double>()> beyond_events;
  double build_seconds = 0;    // of the program, by the clock, before any run
  std::optional<bool> cached;  // whether it came from the binary cache
};

struct WorkGroupTime {
  WorkGroup group;
  Spread seconds;
  /// Seconds that the driver compiled at the size's first launch: its time beyond the events, less that of a
  /// later launch. Nothing where the driver gives no times.
  std::optional<double> compile_seconds;
  std::string problem;  // not empty: no time counts, and why
};

/// The size of the least median, run again in turn with the default.
struct Duel {
  WorkGroup group;
  Spread usual, best;     // seconds
  bool is_clear() const;  // every run of `best` is faster than every run of `usual`, of three or more each
};

struct WorkGroupTimes {
  std::vector<WorkGroupTime> sizes;
  std::optional<Duel> duel;  // nothing where no size has a lesser median than the default
};

/// How often something was measured, of how often it will be.
using OnRun = std::function<void(std::size_t done, std::size_t of)>;

/// Warms each size up, then times `repeat` runs of each in turn. A size whose result is not the default's to
/// the bit, or that the driver refuses, has a problem.
WorkGroupTimes measure_work_groups(const TimedKernel& kernel, int repeat, const OnRun& on_run = {});

/// "best: 8x8, 0.84 of the default's time (...)" or "no clear winner: ...".
std::string verdict_text(const WorkGroupTimes& times);

/// Adds the kernel's table, heat map and measurements.
void add_work_group_tables(Report& report, const TimedKernel& kernel, const WorkGroupTimes& times);

}  // namespace sundog
