// Writes reports for terminals (aligned text) and for programs (JSON and CSV).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "bench/report/report.h"

namespace sundog {
namespace {

using nlohmann::json;

/// Columns that a terminal uses for UTF-8 text.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }));
}

std::string head_text(const Column& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

/// Pads to the width: words align left, numbers right.
std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string space(width - std::min(width, width_of(text)), ' ');
  return left ? text + space : space + text;
}

std::string table_text(const Table& table) {
  std::vector<std::size_t> widths;
  std::vector<bool> left;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    widths.push_back(width_of(head_text(table.columns[i])));
    left.push_back(is_word_column(table, i));
    for (const auto& row : table.rows) widths[i] = std::max(widths[i], width_of(cell_text(row[i])));
  }
  std::string text = table.title.empty() ? "" : table.title + "\n";
  const auto line = [&](const auto& cell_of) {
    std::string row;
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      row += fmt::format("  {}", padded(cell_of(i), widths[i], left[i]));
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  };
  line([&](std::size_t i) { return head_text(table.columns[i]); });
  for (const auto& row : table.rows) line([&](std::size_t i) { return cell_text(row[i]); });
  return text;
}

json spread_json(const Spread& spread) {
  const Interval interval = median_interval(spread);
  json values{{"median", spread.median},
              {"low", interval.low},
              {"high", interval.high},
              {"min", spread.min},
              {"max", spread.max}};
  if (!spread.runs.empty()) values["runs"] = spread.runs;
  return values;
}

/// A name that occurs several times, such as "device", gets an array of its values.
json facts_json(const Facts& all) {
  json facts = json::object();
  for (const auto& [name, value] : all) {
    json& fact = facts[name];
    if (fact.is_string()) fact = json::array({fact});
    if (fact.is_array())
      fact.push_back(value);
    else
      fact = value;
  }
  return facts;
}

json cell_json(const Cell& cell) {
  switch (cell.kind) {
    case Cell::Kind::word:
      return cell.word;
    case Cell::Kind::number:
      return cell.spread.median;
    case Cell::Kind::spread:
      return spread_json(cell.spread);
    default:
      return nullptr;
  }
}

json rows_json(const Table& table) {
  json rows = json::array();
  for (const auto& row : table.rows) {
    json values = json::object();
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      values[plain_name(table.columns[i])] = cell_json(row[i]);
    rows.push_back(std::move(values));
  }
  return rows;
}

json way_json(const MeasuredWay& way) {
  json runs = json::array();
  for (const Run& run : way.runs)
    runs.push_back({{"seconds", run.seconds},
                    {"cores", run.cores},
                    {"others", run.others < 0 ? json() : json(run.others)},
                    {"at", run.at},
                    {"clock_MHz", run.clock > 0 ? json(run.clock) : json()},
                    {"joules", run.joules < 0 ? json() : json(run.joules)},
                    {"watts", run.watts < 0 ? json() : json(run.watts)},
                    {"left_out", run.left_out.empty() ? json() : json(run.left_out)},
                    {"disturbed", run.disturbed.empty() ? json() : json(run.disturbed)}});
  return {{"name", way.name},
          {"problem", way.problem.empty() ? json() : json(way.problem)},
          {"noisy", way.noisy},
          {"runs", std::move(runs)}};
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted;
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", quoted);
}

std::string csv_cell(const Cell& cell, bool as_spread) {
  const Spread& spread = cell.spread;
  if (cell.kind == Cell::Kind::spread)
    return fmt::format("{},{},{},{}", spread.median, spread.min, spread.max, fmt::join(spread.runs, " "));
  const std::string text =
      cell.kind == Cell::Kind::number ? fmt::format("{}", spread.median) : csv_field(cell.word);
  return as_spread ? text + ",,," : text;
}

/// Points around 1 with their intervals, one line each.
std::string ratios_text(const BarPlot& plot) {
  constexpr int width = 49;
  double reach = 0.01;  // of the axis on both sides of 1, as a logarithm
  std::size_t room = 0;
  for (const Bar& bar : plot.bars) {
    for (const double value : {bar.value.min, bar.value.median, bar.value.max})
      if (value > 0 && std::isfinite(value)) reach = std::max(reach, 1.1 * std::abs(std::log(value)));
    room = std::max(room, width_of(bar.label));
  }
  const auto at = [&](double value) {
    const double part = std::clamp(0.5 + 0.5 * std::log(value) / reach, 0.0, 1.0);
    return static_cast<int>(std::lround(part * (width - 1)));
  };
  std::string text;
  for (const Bar& bar : plot.bars) {
    const int low = at(bar.value.min), middle = at(bar.value.median), high = at(bar.value.max);
    text += "  " + padded(bar.label, room, true) + "  ";
    for (int i = 0; i < width; ++i)
      text += i == middle ? "●" : i == width / 2 ? "│" : i >= low && i <= high ? "─" : " ";
    text += fmt::format("  {}\n", bar.note);
  }
  return text + fmt::format("  {:{}}  {:<{}}1{:>{}}\n", "", room, number_text(std::exp(-reach)), width / 2,
                            number_text(std::exp(reach)), width / 2);
}

bool shown_if_known(const std::string& column) {
  return column == "energy" || column == "power" || column == "problem";
}

}  // namespace

bool is_word_column(const Table& table, std::size_t column) {
  return std::ranges::any_of(table.rows,
                             [&](const auto& row) { return row[column].kind == Cell::Kind::word; });
}

std::string plain_name(const Column& column) {
  std::string name = column.unit.empty() ? column.name : column.name + "_" + column.unit;
  std::ranges::replace(name, ' ', '_');
  return name;
}

void add_row(Table& table, const std::vector<Field>& fields) {
  std::vector<Cell>& row = table.rows.emplace_back(table.columns.size());
  for (const Field& field : fields) {
    const auto named = [&](const Column& column) { return column.name == field.name; };
    const auto at =
        static_cast<std::size_t>(std::ranges::find_if(table.columns, named) - table.columns.begin());
    if (at == table.columns.size()) table.columns.push_back({field.name, field.unit});
    row.resize(table.columns.size());
    row[at] = field.cell;
  }
  for (auto& each : table.rows) each.resize(table.columns.size());
}

Cell milliseconds(const MeasuredWay& way) {
  return way.is_good() ? Cell(scaled(way.seconds(), 1e3)) : Cell();
}

void add_row(Table& table, std::vector<Field> row, const MeasuredWay& way) {
  for (const Field& field : measured_fields(way))
    if (shown_if_known(field.name) && field.cell.kind != Cell::Kind::none) row.push_back(field);
  add_row(table, row);
}

std::vector<Field> measured_fields(const MeasuredWay& way) {
  const bool good = way.is_good();
  const Spread others = way.others();
  const auto known = [&](double mean) { return good && mean >= 0 ? Cell(mean) : Cell(); };
  return {{"time", "ms", milliseconds(way)},
          {"runs", "", good ? Cell(static_cast<double>(way.seconds().runs.size())) : Cell()},
          {"cores used", "", good ? Cell(way.cores()) : Cell()},
          {"cores of others", "", good && others.min >= 0 ? Cell(others) : Cell()},
          {"load", "", good ? Cell(way.noisy ? "disturbed" : "quiet") : Cell()},
          {"energy", "J", known(way.joules())},
          {"power", "W", known(way.watts())},
          {"problem", "", way.problem.empty() ? Cell() : Cell(way.problem)}};
}

void add_result(Report& report, const std::vector<Field>& key, std::vector<Field> results) {
  results.insert(results.begin(), key.begin(), key.end());
  add_row(report.measurements, results);
  for (Column& column : report.measurements.columns)
    column.is_parameter |= std::ranges::count(key, column.name, &Field::name) > 0;
}

void add_measured(Report& report, const MeasuredWay& way, const std::vector<Field>& key,
                  const std::vector<Field>& more) {
  std::vector<Field> results = measured_fields(way);
  results.insert(results.end(), more.begin(), more.end());
  add_result(report, key, std::move(results));
  report.ways.push_back(way);
}

std::string number_text(double value) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const double size = std::abs(value);
  if (value == std::floor(value) && size < 1e15) return fmt::format("{:.0f}", value);
  if (size >= 99.95) return fmt::format("{:.0f}", value);
  if (size >= 9.995) return fmt::format("{:.1f}", value);
  if (size >= 0.9995) return fmt::format("{:.2f}", value);
  if (size >= 0.09995) return fmt::format("{:.3f}", value);
  return fmt::format("{:.3g}", value);
}

std::string cell_text(const Cell& cell) {
  const Spread& spread = cell.spread;
  if (cell.kind == Cell::Kind::number) return number_text(spread.median);
  if (cell.kind != Cell::Kind::spread) return cell.word;
  if (!has_interval(spread)) return number_text(spread.median);
  const Interval interval = median_interval(spread);
  return fmt::format("{} [{}, {}]", number_text(spread.median), number_text(interval.low),
                     number_text(interval.high));
}

std::string report_text(const Report& report) {
  std::string text = report.title + "\n";
  std::size_t width = 0;
  for (const auto& [name, value] : report.facts) width = std::max(width, width_of(name));
  for (const auto& [name, value] : report.facts)
    text += fmt::format("  {}  {}\n", padded(name, width, true), value);
  bool any = false;
  for (const Part& part : report.parts) {
    if (const auto* table = std::get_if<Table>(&part)) {
      text += fmt::format("\n{}", table_text(*table));
      any = true;
    }
    if (const auto* plot = std::get_if<BarPlot>(&part); plot && plot->ratios)
      text += "\n" + ratios_text(*plot);
  }
  if (!any) text += fmt::format("\n{}", table_text(report.measurements));
  if (!report.notes.empty()) text += "\n";
  for (const std::string& note : report.notes) text += note + "\n";
  return text;
}

json report_json(const Report& report) {
  json ways = json::array();
  for (const MeasuredWay& way : report.ways) ways.push_back(way_json(way));
  return {{"schema", 2},
          {"bench", report.name},
          {"complete", report.complete},
          {"facts", facts_json(report.facts)},
          {"environment", facts_json(report.environment)},
          {"devices", rows_json(report.devices)},
          {"scenes", rows_json(report.scenes)},
          {"notes", report.notes},
          {"measurements", rows_json(report.measurements)},
          {"ways", std::move(ways)}};
}

std::string report_csv(const Report& report) {
  const Table& table = report.measurements;
  std::string text;
  std::vector<bool> spreads;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const auto holds_spread = [&](const auto& row) { return row[i].kind == Cell::Kind::spread; };
    spreads.push_back(std::ranges::any_of(table.rows, holds_spread));
    const std::string name = csv_field(plain_name(table.columns[i]));
    text += i ? "," : "";
    text += spreads[i] ? fmt::format("{0},{0}_min,{0}_max,{0}_runs", name) : name;
  }
  text += "\r\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format("{}{}", i ? "," : "", csv_cell(row[i], spreads[i]));
    text += "\r\n";
  }
  return text;
}

}  // namespace sundog
