// `sundog bench compare`: compares reports of a bench, or a report's devices, with the first one, row by row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "app/options/command.h"
#include "app/options/option_helpers.h"
#include "app/process/exit_status.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/commands/bench_options.h"
#include "bench/commands/known_report.h"
#include "bench/report/machine.h"
#include "bench/runs/ratio.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

struct CompareOptions : ReportFiles {
  std::vector<std::string> reports;
};

/// One side of the comparison: a report, several calls' reports, or a device.
struct Side {
  std::string name;
  std::vector<KnownReport> calls;
  std::vector<std::string> order;                             // names of its rows
  std::map<std::string, std::vector<std::vector<Run>>> runs;  // by row, then call
  bool in_turn = false;                                       // runs took turns with the other sides'
};

constexpr std::size_t title_at = 2;  // in device_names()

/// "0:0 platform / name", "0:0 name", its title and "0:0": the names of a device in rows, the longest first.
std::vector<std::string> device_names(const KnownReport& report, std::size_t row) {
  const auto& cells = report.devices.rows[row];
  const std::string label = known_cell(report.devices, cells, "label");
  const std::string name = known_cell(report.devices, cells, "name"),
                    place = label.substr(0, label.find(' '));
  return {label, place + " " + name, device_title(label, name), place};
}

std::set<std::string> device_labels(const KnownReport& report) {
  std::set<std::string> labels;
  for (std::size_t i = 0; i < report.devices.rows.size(); ++i) labels.insert(device_names(report, i).front());
  return labels;
}

/// Replaces the first of a device's names in the text; returns whether there was one.
bool replace_device(std::string& text, const std::vector<std::string>& names, const std::string& by) {
  for (const std::string& name : names)
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
      const std::size_t end = at + name.size();
      const bool inside = (at > 0 && std::isdigit(static_cast<unsigned char>(text[at - 1]))) ||
                          (end < text.size() && (std::isdigit(static_cast<unsigned char>(text[end])) ||
                                                 text[end] == '/' || text[end] == '@'));
      if (inside) continue;
      text.replace(at, name.size(), by);
      return true;
    }
  return false;
}

void add_way(Side& side, const std::string& name, const MeasuredWay& way) {
  if (!way.is_good()) return;
  if (!side.runs.contains(name)) side.order.push_back(name);
  side.runs[name].push_back(way.runs);
}

/// Reads a report, or the reports in a folder, which several calls of one bench wrote.
Side read_side(const std::string& name) {
  Side side{fs::path(name).stem().string(), {}, {}, {}, false};
  std::vector<std::string> files{name};
  std::error_code none;
  if (fs::is_directory(name, none)) {
    files.clear();
    for (const auto& entry : fs::directory_iterator(name, none))
      if (lower_extension(entry.path()) == ".json") files.push_back(entry.path().string());
    std::ranges::sort(files);
    if (files.empty()) throw UsageError(name + ": the folder has no report (.json) in it");
  }
  for (const std::string& file : files) side.calls.push_back(read_report(file));
  return side;
}

/// The devices of one report. In `bench devices` they took turns; otherwise they were measured one after the
/// other.
std::vector<Side> sides_of(const KnownReport& report, const std::string& file) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < report.devices.rows.size(); ++i) {
    Side& side =
        sides.emplace_back(Side{device_names(report, i)[title_at], {}, {}, {}, report.bench == "devices"});
    for (const MeasuredWay& way : report.ways) {
      std::string name = way.name;
      if (replace_device(name, device_names(report, i), "the device")) {
        bool has_other = false;
        for (std::size_t k = 0; k < report.devices.rows.size(); ++k)
          has_other = has_other || (k != i && replace_device(name, device_names(report, k), ""));
        if (!has_other) add_way(side, name, way);
      }
    }
  }
  if (sides.size() < 2)
    throw UsageError(fmt::format(
        "bench compare {}: it has one device, so there is nothing to compare; give two reports or more",
        file));
  return sides;
}

/// Throws UsageError if a scene of both reports was measured in another size or with other settings.
void check_scenes(const KnownReport& base, const KnownReport& other, const std::string& file) {
  const auto settings = [](const Table& scenes, const std::vector<Cell>& row) {
    std::map<std::string, std::string> all;
    for (const Column& column : scenes.columns)
      if (column.name != "file" && column.name != "hash")
        all[column.name] = known_cell(scenes, row, column.name);
    return all;
  };
  for (const auto& row : other.scenes.rows) {
    auto own = settings(other.scenes, row);
    std::optional<std::map<std::string, std::string>> like;
    for (const auto& each : base.scenes.rows) {
      auto found = settings(base.scenes, each);
      if (found.at("name") == own.at("name") && (!like || found == own)) like = std::move(found);
    }
    if (!like || *like == own) continue;
    const auto [a, b] = std::ranges::mismatch(*like, own);
    throw UsageError(fmt::format(
        "bench compare {}: scene {} was measured with {} {}, in the first report {}: measure both alike",
        file, own.at("name"), b->first, b->second, a->second));
  }
}

std::vector<Side> read_sides(const std::vector<std::string>& names) {
  std::vector<Side> sides;
  for (const std::string& name : names) sides.push_back(read_side(name));
  const KnownReport& first = sides.front().calls.front();
  if (sides.size() == 1 && sides.front().calls.size() == 1) return sides_of(first, names.front());
  if (sides.size() == 1) throw UsageError("bench compare: give two reports or folders, or one report");
  bool same_devices = true;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const KnownReport& call : sides[i].calls) {
      if (call.bench != first.bench)
        throw UsageError(fmt::format("bench compare {}: it is of bench {}, the first one of bench {}",
                                     names[i], call.bench, first.bench));
      check_scenes(first, call, names[i]);
      same_devices = same_devices && device_labels(call) == device_labels(first);
    }
  for (Side& side : sides)
    for (const KnownReport& call : side.calls)
      for (const MeasuredWay& way : call.ways) {
        std::string name = way.name;
        for (std::size_t k = 0; k < call.devices.rows.size(); ++k) {
          const std::vector<std::string> known = device_names(call, k);
          replace_device(name, known,
                         same_devices                    ? known[title_at]
                         : call.devices.rows.size() == 1 ? "the device"
                                                         : fmt::format("device {}", k + 1));
        }
        add_way(side, name, way);
      }
  return sides;
}

Calls counted(const std::vector<std::vector<Run>>& calls) {
  Calls all;
  for (const std::vector<Run>& runs : calls) {
    MeasuredWay way;
    way.runs = runs;
    all.push_back(way.seconds().runs);
  }
  return all;
}

Spread milliseconds(const std::vector<std::vector<Run>>& calls) {
  std::vector<double> medians;
  const Calls all = counted(calls);
  if (all.size() == 1) return scaled(spread(all.front()), 1e3);
  for (const auto& runs : all) medians.push_back(spread(runs).median);
  return scaled(spread(medians), 1e3);
}

/// Facts that all rows of a comparison share.
struct Tally {
  bool in_turn = false;                                // runs in pairs
  std::size_t fewest_calls = SIZE_MAX, unmatched = 0;  // of a row; rows missing in the base
};

/// Adds the rows that `side` and the base share, and a note on them. Throws UsageError if there are none.
void add_side(Report& report, const Side& base, const Side& side, Tally& tally) {
  Table table{side.name + " against " + base.name, {}, {}};
  BarPlot plot{table.title, "ratio of times", {}, true};
  std::map<std::string, int> verdicts;
  double logs = 0;
  for (const std::string& name : side.order) {
    const auto found = base.runs.find(name);
    tally.unmatched += found == base.runs.end();
    if (found == base.runs.end()) continue;
    const auto &a = found->second, &b = side.runs.at(name);
    const Ratio ratio =
        tally.in_turn ? paired_ratio(a.front(), b.front()) : ratio_of_calls(counted(a), counted(b));
    if (!ratio.is_known()) continue;
    tally.fewest_calls = std::min({tally.fewest_calls, a.size(), b.size()});
    ++verdicts[ratio.verdict()];
    logs += std::log(ratio.value);
    const Spread bounds{ratio.value, ratio.low, ratio.high};
    const Field measured{"measured", "", name}, of_ratio{"ratio", "", bounds},
        verdict{"verdict", "", ratio.verdict()};
    add_row(table,
            {measured, {"base", "ms", milliseconds(a)}, {"time", "ms", milliseconds(b)}, of_ratio, verdict});
    add_result(report, {measured, {"base", "", base.name}, {"other", "", side.name}},
               {{"base time", "ms", milliseconds(a)}, {"time", "ms", milliseconds(b)}, of_ratio, verdict});
    plot.bars.push_back({name, bounds, ratio.verdict()});
  }
  if (table.rows.empty())
    throw UsageError(
        fmt::format("bench compare {}: no row was measured as one of {} was", side.name, base.name));
  const auto rows = static_cast<int>(table.rows.size());
  report.notes.push_back(
      fmt::format("{}: faster in {} of {} rows, slower in {}, not told apart in {}; its times are {} of "
                  "those of {} (geometric mean of the ratios).",
                  side.name, verdicts["faster"], rows, verdicts["slower"], verdicts["not told apart"],
                  number_text(std::exp(logs / rows)), base.name));
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(std::move(plot));
}

/// The report's note on how the intervals were computed.
const char* interval_note(const Tally& tally) {
  if (tally.in_turn)
    return "The devices took turns, so runs are compared pair by pair: the median of their ratios. Fewer "
           "than six pairs tell nothing apart.";
  if (tally.fewest_calls < 6)
    return "Fewer than six calls of each: the interval is that of the ranges of all runs, each widened by "
           "its width at both ends, because calls differ by more than the runs within one. Fewer than six "
           "runs tell nothing apart. Six calls of each, made in turn, with their reports in a folder each, "
           "have a much smaller one.";
  return "Intervals by bootstrap of the medians of the calls' medians. Calls of both have to be made in "
         "turn: what the machine does meanwhile is in the ratio otherwise.";
}

int bench_compare(const CompareOptions& options) {
  check_report_files(options, options.reports);
  const std::vector<Side> sides = read_sides(options.reports);
  const Side& base = sides.front();
  Report report;
  report.name = "compare";
  report.title = "Compared with " + base.name;
  Tally tally;
  tally.in_turn = base.in_turn;
  for (std::size_t i = 1; i < sides.size(); ++i) add_side(report, base, sides[i], tally);
  report.notes.emplace_back(
      "Ratio: the time over that of the base, with an interval that holds it with 95 % confidence. Of twenty "
      "rows that do not differ one may have a verdict by chance.");
  report.notes.emplace_back(interval_note(tally));
  if (tally.unmatched > 0)
    report.notes.push_back(fmt::format("{} row{} that {} has not, left out.", tally.unmatched,
                                       tally.unmatched == 1 ? "" : "s", base.name));
  write_report(report, options);
  return exit_done;
}

}  // namespace

void add_bench_compare(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<CompareOptions>();
  Arguments* app = bench.add_subcommand(
      "compare", "Reports of a bench against the first one: ratios with intervals, and who is faster");
  value(app, "REPORT", "FILE", options->reports,
        "the JSON of a bench, or a folder with that of several calls; one alone: its devices")
      ->required();
  add_report_options(app, *options);
  app->callback([options, &chosen] { chosen = Command{[options] { return bench_compare(*options); }}; });
}

}  // namespace sundog
