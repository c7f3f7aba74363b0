// Reports for terminals and for programs: aligned text, JSON and CSV.
#include <fmt/format.h>

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

bool is_word(const Cell& cell) { return cell.kind == Cell::Kind::word; }

/// Words to the left, numbers to the right.
std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string space(width - std::min(width, width_of(text)), ' ');
  return left ? text + space : space + text;
}

std::string table_text(const Table& table) {
  std::vector<std::size_t> widths;
  std::vector<bool> left;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    widths.push_back(width_of(head_text(table.columns[i])));
    left.push_back(std::ranges::any_of(table.rows, [&](const auto& row) { return is_word(row[i]); }));
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
  json values{{"median", spread.median}, {"min", spread.min}, {"max", spread.max}};
  if (!spread.runs.empty()) values["runs"] = spread.runs;
  return values;
}

/// A name that stands several times, as "device" may, has an array of what it holds.
json facts_json(const Report& report) {
  json facts = json::object();
  for (const auto& [name, value] : report.facts) {
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

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted;
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", quoted);
}

std::string csv_cell(const Cell& cell, bool as_spread) {
  const Spread& spread = cell.spread;
  if (cell.kind == Cell::Kind::spread) return fmt::format("{},{},{}", spread.median, spread.min, spread.max);
  const std::string text =
      cell.kind == Cell::Kind::number ? fmt::format("{}", spread.median) : csv_field(cell.word);
  return as_spread ? text + ",," : text;
}

/// "time [ms]" as a name that programs like: "time_ms".
std::string csv_name(const Column& column) {
  std::string name = column.unit.empty() ? column.name : column.name + "_" + column.unit;
  std::ranges::replace(name, ' ', '_');
  return csv_field(name);
}

}  // namespace

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
  const double half = spread.median != 0 ? 50 * (spread.max - spread.min) / std::abs(spread.median) : 0;
  return fmt::format("{} ±{:.0f}%", number_text(spread.median), half);
}

std::string report_text(const Report& report) {
  std::string text = report.title + "\n";
  std::size_t width = 0;
  for (const auto& [name, value] : report.facts) width = std::max(width, width_of(name));
  for (const auto& [name, value] : report.facts)
    text += fmt::format("  {}  {}\n", padded(name, width, true), value);
  bool any = false;
  for (const Part& part : report.parts)
    if (const auto* table = std::get_if<Table>(&part)) {
      text += fmt::format("\n{}", table_text(*table));
      any = true;
    }
  if (!any) text += fmt::format("\n{}", table_text(report.measurements));
  if (!report.notes.empty()) text += "\n";
  for (const std::string& note : report.notes) text += note + "\n";
  return text;
}

json report_json(const Report& report) {
  json rows = json::array();
  for (const auto& row : report.measurements.rows) {
    json values = json::object();
    for (std::size_t i = 0; i < report.measurements.columns.size(); ++i) {
      const Column& column = report.measurements.columns[i];
      std::string name = column.unit.empty() ? column.name : column.name + "_" + column.unit;
      std::ranges::replace(name, ' ', '_');
      values[name] = cell_json(row[i]);
    }
    rows.push_back(std::move(values));
  }
  return {{"schema", 1},
          {"bench", report.name},
          {"facts", facts_json(report)},
          {"notes", report.notes},
          {"measurements", rows}};
}

std::string report_csv(const Report& report) {
  const Table& table = report.measurements;
  std::string text;
  std::vector<bool> spreads;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const auto holds_spread = [&](const auto& row) { return row[i].kind == Cell::Kind::spread; };
    spreads.push_back(std::ranges::any_of(table.rows, holds_spread));
    const std::string name = csv_name(table.columns[i]);
    text += i ? "," : "";
    text += spreads[i] ? fmt::format("{0},{0}_min,{0}_max", name) : name;
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
