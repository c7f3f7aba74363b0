// See work_groups.h.
#include "bench/frames/work_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "base/error.h"
#include "render/device/tuning.h"

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

const WorkGroupTime* least_time(const std::vector<WorkGroupTime>& times) {
  const WorkGroupTime* least = nullptr;
  for (const WorkGroupTime& time : times)
    if (time.problem.empty() && (!least || time.seconds.median < least->seconds.median)) least = &time;
  return least;
}

std::string title_of(const TimedKernel& kernel) {
  return fmt::format("{}, {} on {}", kernel.scene, kernel.name, kernel.device);
}

HeatMap heat_map(const TimedKernel& kernel, const std::vector<WorkGroupTime>& times, bool has_best) {
  std::set<std::size_t> xs, ys;
  for (const WorkGroupTime& time : times)
    if (time.group.kind == fixed) xs.insert(time.group.x), ys.insert(time.group.y);
  HeatMap map{title_of(kernel) + ": ms by work-group", "ms", "work-items in x", "in y", {}, {}, {}, has_best};
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

/// The sizes that people ask about: the default, the driver's, a prime one, and the one of the least median.
BarPlot bars(const TimedKernel& kernel, const WorkGroupTimes& times) {
  BarPlot plot{title_of(kernel) + ": selected sizes", "ms", {}};
  const WorkGroupTime *usual = default_time(times.sizes), *least = least_time(times.sizes);
  const bool is_best = times.duel && times.duel->is_clear();
  for (const WorkGroupTime& time : times.sizes) {
    const bool prime =
        time.group.kind == fixed && std::ranges::count(primes, time.group.x) > 0 && time.group.y == 1;
    if (!time.problem.empty() || (time.group.kind == fixed && !prime && &time != least)) continue;
    std::string label = work_group_text(time.group);
    if (prime) label += ", padded";
    if (is_best && &time == least) label.insert(0, "best: ");
    const bool compared = usual && usual->seconds.median > 0 && &time != usual;
    plot.bars.push_back(
        {label, scaled(time.seconds, 1e3),
         compared ? fmt::format("{:.2f} of the default", time.seconds.median / usual->seconds.median) : ""});
  }
  return plot;
}

Cell compile_cell(const WorkGroupTime& time) {
  return time.compile_seconds ? Cell(1e3 * *time.compile_seconds) : Cell();
}

Table table(const TimedKernel& kernel, const std::vector<WorkGroupTime>& times) {
  Table result{
      title_of(kernel),
      {{"work-group", ""}, {"time", "ms"}, {"of the default", ""}, {"compiled at first launch", "ms"}},
      {}};
  const WorkGroupTime* usual = default_time(times);
  const bool problems = std::ranges::any_of(times, [](const auto& time) { return !time.problem.empty(); });
  if (problems) result.columns.push_back({"problem", ""});
  for (const WorkGroupTime& time : times) {
    std::vector<Cell> row{work_group_text(time.group)};
    if (time.problem.empty()) {
      row.push_back(scaled(time.seconds, 1e3));
      row.push_back(usual ? Cell(time.seconds.median / usual->seconds.median) : Cell());
      row.push_back(compile_cell(time));
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

namespace {

/// One after another in another order each time, so that what else the machine does falls on all alike.
struct Sweep {
  const TimedKernel& kernel;
  const OnRun& on_run;
  std::size_t done = 0, of = 0;
  std::mt19937 random = std::mt19937();

  double run(const WorkGroup& group) {
    const double seconds = kernel.run(group);
    ++done;
    if (on_run) on_run(done, of);
    return seconds;
  }
  std::optional<double> beyond_events() const {
    return kernel.beyond_events ? kernel.beyond_events() : std::nullopt;
  }
};

/// Runs each size for the first time, and compares its result.
std::vector<WorkGroupTime> warm_up(Sweep& sweep, const std::vector<WorkGroup>& groups) {
  std::vector<WorkGroupTime> times;
  std::uint64_t expected = 0;
  for (const WorkGroup& group : groups) {
    WorkGroupTime& time = times.emplace_back();
    time.group = group;
    try {
      sweep.run(group);
      time.compile_seconds = sweep.beyond_events();
      if (group.kind == automatic)
        expected = sweep.kernel.result();
      else if (sweep.kernel.result() != expected)
        time.problem = "its result is not the default's";
    } catch (const DeviceError& error) {
      time.problem = error.what();
    }
  }
  return times;
}

void time_sizes(Sweep& sweep, std::vector<WorkGroupTime>& times, int repeat) {
  std::vector<std::vector<double>> seconds(times.size()), beyond(times.size());
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int i = 0; i < repeat; ++i) {
    std::shuffle(order.begin(), order.end(), sweep.random);
    for (const std::size_t k : order) {
      if (!times[k].problem.empty()) continue;
      seconds[k].push_back(sweep.run(times[k].group));
      if (const auto more = sweep.beyond_events()) beyond[k].push_back(*more);
    }
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k].seconds = spread(seconds[k]);
    // The rest of a later launch is no compiling: queueing, and the host's own work.
    if (times[k].compile_seconds && !beyond[k].empty())
      times[k].compile_seconds = std::max(0.0, *times[k].compile_seconds - spread(beyond[k]).median);
  }
}

/// Of dozens of sizes the one of the least median owes some of it to luck: it must win again.
std::optional<Duel> run_duel(Sweep& sweep, const std::vector<WorkGroupTime>& times, int repeat) {
  const WorkGroupTime *usual = default_time(times), *least = least_time(times);
  if (!usual || least == usual) return {};
  std::vector<double> of_usual, of_least;
  for (int i = 0; i < repeat; ++i) {
    if (i % 2 == 0) of_usual.push_back(sweep.run(usual->group));
    of_least.push_back(sweep.run(least->group));
    if (i % 2 == 1) of_usual.push_back(sweep.run(usual->group));
  }
  return Duel{least->group, spread(of_usual), spread(of_least)};
}

std::string range_text(const Spread& seconds) {
  return fmt::format("{} to {} ms", number_text(1e3 * seconds.min), number_text(1e3 * seconds.max));
}

std::vector<Cell> measurement(const TimedKernel& kernel, const WorkGroup& group, const char* round) {
  std::vector<Cell> row{kernel.scene, kernel.device, kernel.name, work_group_text(group),
                        Cell(),       Cell(),        round};
  if (group.kind == fixed) row[4] = static_cast<double>(group.x), row[5] = static_cast<double>(group.y);
  return row;
}

}  // namespace

bool Duel::is_clear() const { return best.runs.size() >= 3 && best.max < usual.min; }

WorkGroupTimes measure_work_groups(const TimedKernel& kernel, int repeat, const OnRun& on_run) {
  const std::vector<WorkGroup> groups = work_group_candidates(kernel.limit, kernel.two_dimensions);
  const auto repeats = static_cast<std::size_t>(repeat);
  Sweep sweep{kernel, on_run, 0, groups.size() * (1 + repeats) + 2 * repeats};
  WorkGroupTimes times{warm_up(sweep, groups), {}};
  time_sizes(sweep, times.sizes, repeat);
  times.duel = run_duel(sweep, times.sizes, repeat);
  return times;
}

std::string verdict_text(const WorkGroupTimes& times) {
  if (!times.duel) return "no clear winner: no size has a smaller median than the default";
  const Duel& duel = *times.duel;
  if (duel.best.runs.size() < 3) return "no clear winner: too few runs to name one (--repeat 3 or more)";
  const std::string name = work_group_text(duel.group), best = range_text(duel.best),
                    usual = range_text(duel.usual);
  if (!duel.is_clear())
    return fmt::format("no clear winner: {}, the size with the smallest median, took {}, the default {}",
                       name, best, usual);
  return fmt::format("best: {} took {}, {:.2f} of the default's time ({})", name, best,
                     duel.best.median / duel.usual.median, usual);
}

void add_work_group_tables(Report& report, const TimedKernel& kernel, const WorkGroupTimes& times) {
  const bool best_in_map = times.duel && times.duel->is_clear() && times.duel->group.kind == fixed;
  report.parts.push_back(bars(kernel, times));
  report.parts.push_back(heat_map(kernel, times.sizes, best_in_map));
  report.parts.push_back(table(kernel, times.sizes));
  report.notes.push_back(fmt::format("{}: {}.", title_of(kernel), verdict_text(times)));
  Table& all = report.measurements;
  if (all.columns.empty())
    all.columns = {{"scene", ""},   {"device", ""},
                   {"kernel", ""},  {"work-group", ""},
                   {"local x", ""}, {"local y", ""},
                   {"round", ""},   {"time", "ms"},
                   {"runs", ""},    {"compiled at first launch", "ms"},
                   {"problem", ""}};
  for (const WorkGroupTime& time : times.sizes) {
    std::vector<Cell> row = measurement(kernel, time.group, "sweep");
    const bool good = time.problem.empty();
    row.push_back(good ? Cell(scaled(time.seconds, 1e3)) : Cell());
    row.push_back(good ? Cell(static_cast<double>(time.seconds.runs.size())) : Cell());
    row.push_back(good ? compile_cell(time) : Cell());
    row.push_back(good ? Cell() : Cell(time.problem));
    all.rows.push_back(std::move(row));
  }
  if (!times.duel) return;
  for (const auto& [group, seconds] :
       {std::pair(WorkGroup{}, times.duel->usual), std::pair(times.duel->group, times.duel->best)}) {
    std::vector<Cell> row = measurement(kernel, group, "duel");
    row.insert(row.end(), {scaled(seconds, 1e3), static_cast<double>(seconds.runs.size()), Cell(), Cell()});
    all.rows.push_back(std::move(row));
  }
}

}  // namespace sundog
