// Spends 4/5 of the budget on all sizes in turn and the rest on a duel of the fastest size with the default,
// since the least of many medians is partly luck.
#include "bench/frames/work_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/runs/ratio.h"
#include "render/device/tuning.h"

namespace sundog {
namespace {

using enum WorkGroup::Kind;

// Larger groups of two dimensions gain nothing that smaller ones do not: a group's pixels are together either
// way.
constexpr std::size_t most_in_two_dimensions = 256;

/// Primes just below powers of two: image sizes are rarely their multiples, so ranges are padded.
constexpr std::size_t primes[] = {61, 31, 13, 7, 3};

bool is_padded_prime(const WorkGroup& group) {
  return group.kind == fixed && std::ranges::count(primes, group.x) > 0 && group.y == 1;
}

std::string range_text(const Spread& seconds) {
  const Interval interval = median_interval(seconds);
  return fmt::format("{} to {} ms", number_text(1e3 * interval.low), number_text(1e3 * interval.high));
}

}  // namespace

std::vector<WorkGroup> work_group_candidates(std::size_t limit, bool two_dimensions) {
  std::vector<WorkGroup> groups{{driver, 0, 0}};
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

std::optional<double> WorkGroupTimes::Way::compile_seconds() const {
  if (beyond.size() < 2) return {};
  // A later launch spends this time on queueing and the host's own work, not on compiling.
  return std::max(0.0, beyond.front() - spread({beyond.begin() + 1, beyond.end()}).median);
}

WorkGroupTimes::WorkGroupTimes(TimedKernel head, std::function<TimedKernel()> open)
    : name_(fmt::format("{}, {} on {}", head.scene, head.name, head.device)),
      open_(std::move(open)),
      kernel_(std::move(head)) {}

void WorkGroupTimes::add_way(const WorkGroup& group, const std::string& text) {
  const auto way = std::make_shared<Way>(Way{group, group, text, {}});
  ways_.push_back(way);
  Subject& subject = subjects_.emplace_back();
  subject.name = fmt::format("{}, {}", name_, text);
  subject.devices = kernel_.devices;
  subject.run = [this, way] {
    const double seconds = kernel_.run(way->group);
    const auto more = kernel_.beyond_events ? kernel_.beyond_events() : std::nullopt;
    if (more) way->beyond.push_back(*more);
    return seconds;
  };
  subject.check = [this]() -> std::string {
    return kernel_.result() == expected_ ? "" : "its result is not the default's";
  };
}

void WorkGroupTimes::measure(const MeasureOptions& options) {
  if (options.on_step) options.on_step(name_ + ", the default", 0);
  add_way({}, "default");
  const auto open = [&] {
    kernel_ = open_();
    const auto result = [&] {
      kernel_.run({});
      return kernel_.result();
    };
    expected_ = confirmed<std::uint64_t>(result, std::equal_to<>());
  };
  if (!prepared(subjects_, options, open) || options.is_stopped()) return;
  const auto [x, y] = kernel_.local ? kernel_.local() : std::pair<std::size_t, std::size_t>();
  const WorkGroup usual{fixed, x, y};
  if (x > 0) ways_.front()->enqueued = usual;
  ways_.front()->text = fmt::format("default ({})", x > 0 ? work_group_text(usual) : "the driver's choice");
  std::vector<WorkGroup> groups = kernel_.sizes;
  if (groups.empty()) groups = work_group_candidates(kernel_.limit, kernel_.two_dimensions);
  for (const WorkGroup& group : groups) {
    const bool is_default = group.kind == fixed ? x == group.x && y == group.y : x == 0;
    if (!is_default) add_way(group, group.kind == driver ? "driver's choice" : work_group_text(group));
  }
  MeasureOptions sweep = options, duel = options;
  sweep.budget *= 0.8, duel.budget *= 0.2;
  sundog::measure(subjects_, sweep);
  // The least median of dozens is partly luck, so its size must win again.
  const Subject* best = least();
  if (!best || best == &subjects_.front() || options.is_stopped()) return;
  duel_ = {subjects_.front(), *best};
  for (Subject& subject : duel_) {
    subject.name += ", duel";
    subject.runs.clear();
    subject.noisy = false;
  }
  sundog::measure(duel_, duel);
}

const Subject* WorkGroupTimes::least() const {
  const Subject* least = nullptr;
  for (const Subject& subject : subjects_)
    if (subject.is_good() && (!least || subject.seconds().median < least->seconds().median)) least = &subject;
  return subjects_.empty() || !subjects_.front().is_good() ? nullptr : least;
}

const std::string& WorkGroupTimes::text_of(const Subject& subject) const {
  return ways_[static_cast<std::size_t>(&subject - subjects_.data())]->text;
}

bool WorkGroupTimes::is_clear() const {
  if (duel_.empty() || !duel_[0].is_good() || !duel_[1].is_good()) return false;
  // The two took turns, so the machine's state is divided out of the pairs' ratios. Of fewer than six pairs
  // the range holds the median in less than 95 of 100 cases (of three, in 75), so they have no verdict.
  return paired_ratio(duel_[0].runs, duel_[1].runs).verdict() == std::string("faster");
}

std::string WorkGroupTimes::verdict() const {
  if (duel_.empty()) return "no clear winner: no size has a smaller median than the default";
  for (const Subject& subject : duel_)
    if (!subject.problem.empty())
      return fmt::format("no clear winner: {} failed: {}", subject.name, subject.problem);
  const Spread usual = duel_[0].seconds(), best = duel_[1].seconds();
  if (!paired_ratio(duel_[0].runs, duel_[1].runs).is_enough)
    return fmt::format(
        "no clear winner: too few runs to name one (--repeat {} or more, and a --budget for them)",
        fewest_for_interval);
  const Subject* winner = least();
  const std::string name = winner ? text_of(*winner) : "";
  if (!is_clear())
    return fmt::format("no clear winner: {}, the size with the smallest median, took {}, the default {}",
                       name, range_text(best), range_text(usual));
  return fmt::format("best: {} took {}, {:.2f} of the default's time ({})", name, range_text(best),
                     best.median / usual.median, range_text(usual));
}

HeatMap WorkGroupTimes::heat_map() const {
  std::set<std::size_t> xs, ys;
  for (const auto& way : ways_)
    if (way->enqueued.kind == fixed) xs.insert(way->enqueued.x), ys.insert(way->enqueued.y);
  HeatMap map{name_ + ": ms by work-group", "ms", "work-items in x", "in y", {}, {}, {}, is_clear()};
  for (const std::size_t x : xs) map.columns.push_back(std::to_string(x));
  for (const std::size_t y : ys) {
    map.rows.push_back(std::to_string(y));
    auto& row = map.values.emplace_back(xs.size());
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      const WorkGroup& size = ways_[i]->enqueued;
      if (size.kind == fixed && size.y == y && subjects_[i].is_good())
        row[static_cast<std::size_t>(std::distance(xs.begin(), xs.find(size.x)))] =
            1e3 * subjects_[i].seconds().median;
    }
  }
  return map;
}

/// The sizes that people ask about: the default, the driver's choice, the prime, and the size with the least
/// median.
BarPlot WorkGroupTimes::bars() const {
  BarPlot plot{name_ + ": selected sizes", "ms", {}};
  const Subject* best = least();
  const double usual = subjects_.empty() ? 0 : subjects_.front().seconds().median;
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const WorkGroup& group = ways_[i]->group;
    if (!subjects_[i].is_good()) continue;
    if (group.kind == fixed && !is_padded_prime(group) && &subjects_[i] != best) continue;
    std::string label = ways_[i]->text;
    if (is_padded_prime(group)) label += ", padded";
    if (is_clear() && &subjects_[i] == best) label.insert(0, "best: ");
    plot.bars.push_back({label, scaled(subjects_[i].seconds(), 1e3),
                         usual > 0 && i > 0
                             ? fmt::format("{:.2f} of the default", subjects_[i].seconds().median / usual)
                             : ""});
  }
  return plot;
}

Table WorkGroupTimes::table() const {
  Table result{
      name_,
      {{"work-group", ""}, {"time", "ms"}, {"of the default", ""}, {"compiled at first launch", "ms"}},
      {}};
  const bool compared = !subjects_.empty() && subjects_.front().is_good();
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const Subject& subject = subjects_[i];
    std::vector<Field> row{{"work-group", "", ways_[i]->text}};
    if (subject.is_good()) {
      row.push_back({"time", "ms", milliseconds(subject)});
      if (compared)
        row.push_back({"of the default", "", subject.seconds().median / subjects_.front().seconds().median});
      if (const auto compile = ways_[i]->compile_seconds())
        row.push_back({"compiled at first launch", "ms", 1e3 * *compile});
    }
    add_row(result, row, subject);
  }
  return result;
}

void WorkGroupTimes::add_to(Report& report) const {
  report.parts.push_back(bars());
  report.parts.push_back(heat_map());
  report.parts.push_back(table());
  if (!subjects_.empty() && subjects_.front().is_good()) {
    report.notes.push_back(fmt::format("{}: {}.", name_, verdict()));
    const char* origin = !kernel_.cached   ? "built or loaded from the cache"
                         : *kernel_.cached ? "loaded from the cache"
                                           : "built";
    report.notes.push_back(fmt::format("{}: the program was {} in {} ms, before any run.", name_, origin,
                                       number_text(1e3 * kernel_.build_seconds)));
  }
  const auto measured = [&](const Subject& subject, const Way& way, const char* round) {
    std::vector<Field> row{{"scene", "", kernel_.scene}, {"device", "", kernel_.device},
                           {"kernel", "", kernel_.name}, {"work-group", "", way.text},
                           {"local x", "", Cell()},      {"local y", "", Cell()},
                           {"round", "", round}};
    if (way.group.kind == fixed) {
      row[4].cell = static_cast<double>(way.group.x);
      row[5].cell = static_cast<double>(way.group.y);
    }
    std::vector<Field> more;
    const auto compile = way.compile_seconds();
    if (round == std::string("sweep"))
      more.push_back({"compiled at first launch", "ms", compile ? Cell(1e3 * *compile) : Cell()});
    add_measured(report, subject, row, more);
  };
  for (std::size_t i = 0; i < ways_.size(); ++i) measured(subjects_[i], *ways_[i], "sweep");
  if (duel_.empty() || !least()) return;
  measured(duel_[0], *ways_[0], "duel");
  measured(duel_[1], *ways_[static_cast<std::size_t>(least() - subjects_.data())], "duel");
}

}  // namespace sundog
