// Times of a kernel for every sensible work-group size.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/report.h"
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
  double build_seconds = 0;
  bool cached = false;  // the build came from the binary cache
};

struct WorkGroupTime {
  WorkGroup group;
  Spread seconds;
  double first_run = 0;  // seconds beyond the median: what the driver still had to compile
  std::string problem;   // not empty: no time counts, and why
};

/// Warms each size up, then times `repeat` runs of each in turn. A size whose result is not the default's to
/// the bit, or that the driver refuses, has a problem.
std::vector<WorkGroupTime> measure_work_groups(const TimedKernel& kernel, int repeat);

/// Adds the kernel's table, heat map and measurements.
void add_work_group_tables(Report& report, const TimedKernel& kernel, const std::vector<WorkGroupTime>& times,
                           int repeat);

}  // namespace sundog
