// See known_report.h.
#include "app/bench/known_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"

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

MeasuredWay way_of(const json& value) {
  MeasuredWay way;
  way.name = value.at("name").get<std::string>();
  way.problem = text_of(value.at("problem"));
  for (const json& run : value.at("runs"))
    way.runs.push_back({run.at("seconds").get<double>(), run.at("cores").get<double>(),
                        run.at("others").is_null() ? -1 : run.at("others").get<double>(),
                        run.at("at").get<double>(), text_of(run.at("left_out"))});
  return way;
}

}  // namespace

KnownReport read_known_report(const std::string& file, const std::string& bench,
                              const std::string& revision) {
  const auto refuse = [&](const std::string& why) {
    return UsageError(fmt::format("--continue {}: {}", file, why));
  };
  try {
    const json report = json::parse(read_file(file));
    if (report.at("schema") != 2) throw refuse("it has another schema; measure anew");
    if (report.at("bench") != bench) throw refuse("it is of bench " + text_of(report.at("bench")));
    if (report.at("facts").at("revision") != revision)
      throw refuse(fmt::format("revision {} has measured it, this is {}: measure anew",
                               text_of(report.at("facts").at("revision")), revision));
    KnownReport known{table_of(report.at("devices")), table_of(report.at("scenes")), {}};
    for (const json& value : report.at("ways"))
      if (MeasuredWay way = way_of(value); way.problem.empty()) known.ways[way.name] = std::move(way);
    return known;
  } catch (const json::exception&) {
    throw refuse("it is no report of sundog bench --json");
  }
}

void check_known(const Table& known, const Table& rows, const std::string& name, const std::string& file) {
  const auto cell = [](const Table& table, const std::vector<Cell>& row, const std::string& column) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      // A report has names such as programs like.
      std::string found = table.columns[i].unit.empty() ? table.columns[i].name
                                                        : table.columns[i].name + "_" + table.columns[i].unit;
      std::ranges::replace(found, ' ', '_');
      if (found == column) return cell_text(row[i]);
    }
    return std::string();
  };
  const std::vector<Cell>& mine = rows.rows.back();
  const std::string own = cell(rows, mine, name);
  bool any = false;
  for (const auto& row : known.rows) {
    if (cell(known, row, name) != own) continue;
    any = true;
    const bool same = std::ranges::all_of(known.columns, [&](const Column& column) {
      return column.name == "file" || cell(known, row, column.name) == cell(rows, mine, column.name);
    });
    if (same) return;
  }
  if (any)
    throw UsageError(fmt::format(
        "--continue {}: it has measured another {}; measure anew, or give the options that made it", file,
        own));
}

}  // namespace sundog
