// Reads the JSON of `bench --json` back into tables and runs.
#include "bench/commands/known_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/input.h"

namespace sundog {
namespace {

using nlohmann::json;

std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : ""; }

Table table_of(const json& rows) {
  Table table;
  for (const json& row : rows) {
    std::vector<Field> fields;
    for (const auto& [name, value] : row.items())
      fields.push_back({name, "", value.is_number() ? Cell(value.get<double>()) : Cell(text_of(value))});
    add_row(table, fields);
  }
  return table;
}

double number(const json& run, const char* name, double otherwise) {
  return run.contains(name) && run[name].is_number() ? run[name].get<double>() : otherwise;
}

MeasuredWay way_of(const json& value) {
  MeasuredWay way;
  way.name = value.at("name").get<std::string>();
  way.problem = text_of(value.at("problem"));
  for (const json& run : value.at("runs"))
    way.runs.push_back({run.at("seconds").get<double>(), run.at("cores").get<double>(),
                        number(run, "others", -1), run.at("at").get<double>(), text_of(run.at("left_out")),
                        number(run, "clock_MHz", 0), number(run, "joules", -1), number(run, "watts", -1),
                        run.contains("disturbed") ? text_of(run["disturbed"]) : ""});
  return way;
}

}  // namespace

KnownReport read_report(const std::string& file) {
  try {
    const json report = json::parse(read_input(file));
    if (!report.contains("bench")) throw SceneError(file, "", "it is no report of sundog bench --json");
    if (report.at("schema") != 2) throw SceneError(file, "", "it has another schema; measure anew");
    KnownReport known{text_of(report.at("bench")),
                      text_of(report.at("facts").at("revision")),
                      table_of(report.at("devices")),
                      table_of(report.at("scenes")),
                      {}};
    for (const json& way : report.at("ways")) known.ways.push_back(way_of(way));
    return known;
  } catch (const json::exception&) {
    throw SceneError(file, "", "it is no report of sundog bench --json");
  }
}

std::string known_cell(const Table& table, const std::vector<Cell>& row, const std::string& column) {
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (plain_name(table.columns[i]) == column) return cell_text(row[i]);
  return {};
}

void check_known(const Table& known, const Table& rows, const std::vector<std::string>& keys,
                 const std::string& file) {
  const std::vector<Cell>& mine = rows.rows.back();
  bool any = false;
  for (const auto& row : known.rows) {
    const auto same = [&](const std::string& column) {
      return known_cell(known, row, column) == known_cell(rows, mine, column);
    };
    if (!std::ranges::all_of(keys, same)) continue;
    any = true;
    if (std::ranges::all_of(known.columns,
                            [&](const Column& column) { return column.name == "file" || same(column.name); }))
      return;
  }
  if (any)
    throw UsageError(fmt::format(
        "--continue {}: it has measured another {}; measure anew, or give the options that made it", file,
        known_cell(rows, mine, keys.front())));
}

}  // namespace sundog
