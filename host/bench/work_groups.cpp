// See work_groups.h.
#include "bench/work_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "base/error.h"

namespace sundog {
namespace {

using enum WorkGroup::Kind;

// Larger groups of two dimensions gain nothing that smaller ones do not: a group's pixels are together either
// way.
constexpr std::size_t most_in_two_dimensions = 256;

/// Primes below the powers of two: no range of pixels is a multiple of one.
constexpr std::size_t primes[] = {61, 31, 13, 7, 3};

const WorkGroupTime* default_time(const std::vector<WorkGroupTime>& times) {
  for (const WorkGroupTime& time : times)
    if (time.group.kind == automatic && time.problem.empty()) return &time;
  return nullptr;
}

const WorkGroupTime* best_time(const std::vector<WorkGroupTime>& times) {
  const WorkGroupTime* best = nullptr;
  for (const WorkGroupTime& time : times)
    if (time.problem.empty() && (!best || time.seconds.median < best->seconds.median)) best = &time;
  return best;
}

std::string title_of(const TimedKernel& kernel) {
  return fmt::format("{}, {} on {}", kernel.scene, kernel.name, kernel.device);
}

HeatMap heat_map(const TimedKernel& kernel, const std::vector<WorkGroupTime>& times) {
  std::set<std::size_t> xs, ys;
  for (const WorkGroupTime& time : times)
    if (time.group.kind == fixed) xs.insert(time.group.x), ys.insert(time.group.y);
  HeatMap map{title_of(kernel) + ": ms by work-group", "ms", "work-items in x", "in y", {}, {}, {}};
  for (const std::size_t x : xs) map.columns.push_back(std::to_string(x));
  for (const std::size_t y : ys) {
    map.rows.push_back(std::to_string(y));
    auto& row = map.values.emplace_back(xs.size());
    for (const WorkGroupTime& time : times)
      if (time.group.kind == fixed && time.group.y == y && time.problem.empty())
        row[static_cast<std::size_t>(std::distance(xs.begin(), xs.find(time.group.x)))] =
            1e3 * time.seconds.median;
  }
  return map;
}

/// The sizes that people ask about: the best, the default, the driver's and the prime.
BarPlot bars(const TimedKernel& kernel, const std::vector<WorkGroupTime>& times) {
  BarPlot plot{title_of(kernel) + ": the best beside what one gets without asking", "ms", {}};
  const WorkGroupTime* best = best_time(times);
  if (!best) return plot;
  const auto add = [&](const WorkGroupTime& time, const std::string& label) {
    const double ratio = time.seconds.median / best->seconds.median;
    plot.bars.push_back(
        {label, scaled(time.seconds, 1e3), &time == best ? "" : fmt::format("{:.2f} ×", ratio)});
  };
  add(*best, "best: " + work_group_text(best->group));
  for (const WorkGroupTime& time : times) {
    if (!time.problem.empty() || &time == best) continue;
    const bool prime =
        time.group.kind == fixed && std::ranges::count(primes, time.group.x) > 0 && time.group.y == 1;
    if (time.group.kind != fixed) add(time, work_group_text(time.group));
    if (prime) add(time, fmt::format("{}, padded", time.group.x));
  }
  return plot;
}

Table table(const TimedKernel& kernel, const std::vector<WorkGroupTime>& times) {
  Table result{title_of(kernel),
               {{"work-group", ""}, {"time", "ms"}, {"of the default", ""}, {"compiled in", "ms"}},
               {}};
  const WorkGroupTime* usual = default_time(times);
  const bool problems = std::ranges::any_of(times, [](const auto& time) { return !time.problem.empty(); });
  if (problems) result.columns.push_back({"problem", ""});
  for (const WorkGroupTime& time : times) {
    std::vector<Cell> row{work_group_text(time.group)};
    if (time.problem.empty()) {
      row.push_back(scaled(time.seconds, 1e3));
      row.push_back(usual ? Cell(time.seconds.median / usual->seconds.median) : Cell());
      row.push_back(1e3 * time.first_run);
    }
    row.resize(result.columns.size());
    if (problems) row.back() = time.problem;
    result.rows.push_back(std::move(row));
  }
  return result;
}

}  // namespace

std::vector<WorkGroup> work_group_candidates(std::size_t limit, bool two_dimensions) {
  std::vector<WorkGroup> groups{{automatic, 0, 0}, {driver, 0, 0}};
  for (std::size_t x = 1; x <= limit; x *= 2) groups.push_back({fixed, x, 1});
  for (const std::size_t prime : primes)
    if (prime <= limit) {
      groups.push_back({fixed, prime, 1});
      break;
    }
  const std::size_t most = std::min(limit, most_in_two_dimensions);
  for (std::size_t y = 2; two_dimensions && y <= most; y *= 2)
    for (std::size_t x = 1; x * y <= most; x *= 2) groups.push_back({fixed, x, y});
  return groups;
}

std::vector<WorkGroupTime> measure_work_groups(const TimedKernel& kernel, int repeat) {
  std::vector<WorkGroupTime> times;
  std::uint64_t expected = 0;
  for (const WorkGroup& group : work_group_candidates(kernel.limit, kernel.two_dimensions)) {
    WorkGroupTime& time = times.emplace_back();
    time.group = group;
    try {
      time.first_run = kernel.run(group);
      if (group.kind == automatic)
        expected = kernel.result();
      else if (kernel.result() != expected)
        time.problem = "its result is not the default's";
    } catch (const DeviceError& error) {
      time.problem = error.what();
    }
  }
  std::vector<std::vector<double>> seconds(times.size());
  // In another order each time, so that what else the machine does falls on all sizes alike.
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random;
  for (int i = 0; i < repeat; ++i) {
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t k : order)
      if (times[k].problem.empty()) seconds[k].push_back(kernel.run(times[k].group));
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k].seconds = spread(seconds[k]);
    times[k].first_run = std::max(0.0, times[k].first_run - times[k].seconds.median);
  }
  return times;
}

void add_work_group_tables(Report& report, const TimedKernel& kernel, const std::vector<WorkGroupTime>& times,
                           int repeat) {
  report.parts.push_back(bars(kernel, times));
  report.parts.push_back(heat_map(kernel, times));
  report.parts.push_back(table(kernel, times));
  Table& all = report.measurements;
  if (all.columns.empty())
    all.columns = {{"scene", ""},   {"device", ""}, {"kernel", ""}, {"work-group", ""},    {"local x", ""},
                   {"local y", ""}, {"time", "ms"}, {"runs", ""},   {"compiled in", "ms"}, {"problem", ""}};
  for (const WorkGroupTime& time : times) {
    std::vector<Cell> row{kernel.scene, kernel.device, kernel.name, work_group_text(time.group)};
    const bool fixed_size = time.group.kind == fixed, good = time.problem.empty();
    row.push_back(fixed_size ? Cell(static_cast<double>(time.group.x)) : Cell());
    row.push_back(fixed_size ? Cell(static_cast<double>(time.group.y)) : Cell());
    row.push_back(good ? Cell(scaled(time.seconds, 1e3)) : Cell());
    row.push_back(good ? Cell(static_cast<double>(repeat)) : Cell());
    row.push_back(good ? Cell(1e3 * time.first_run) : Cell());
    row.push_back(good ? Cell() : Cell(time.problem));
    all.rows.push_back(std::move(row));
  }
}

}  // namespace sundog
