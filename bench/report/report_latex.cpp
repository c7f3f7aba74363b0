// Reports for papers and for other tuners: LaTeX with booktabs, and the T4 format.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "bench/report/report.h"

namespace sundog {
namespace {

using nlohmann::json;

std::string escaped(const std::string& text) {
  static const std::map<char, const char*> commands{{'&', "\\&"},
                                                    {'%', "\\%"},
                                                    {'$', "\\$"},
                                                    {'#', "\\#"},
                                                    {'_', "\\_"},
                                                    {'{', "\\{"},
                                                    {'}', "\\}"},
                                                    {'~', "\\textasciitilde{}"},
                                                    {'^', "\\textasciicircum{}"},
                                                    {'\\', "\\textbackslash{}"},
                                                    {'[', "{[}"}};
  std::string safe;
  for (const char c : text)
    if (const auto found = commands.find(c); found != commands.end())
      safe += found->second;
    else
      safe += c;
  return safe;
}

std::string cell_latex(const Cell& cell) {
  if (cell.kind != Cell::Kind::spread || !has_interval(cell.spread)) return escaped(cell_text(cell));
  const Interval interval = median_interval(cell.spread);
  return fmt::format("{} {{\\footnotesize[{}, {}]}}", number_text(cell.spread.median),
                     number_text(interval.low), number_text(interval.high));
}

std::string table_latex(const Table& table) {
  std::string columns, head, body;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const Column& column = table.columns[i];
    columns += is_word_column(table, i) ? 'l' : 'r';
    head += i ? " & " : "";
    head += escaped(column.name) + (column.unit.empty() ? "" : " (" + escaped(column.unit) + ")");
  }
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) body += (i ? " & " : "") + cell_latex(row[i]);
    body += " \\\\\n";
  }
  return fmt::format(
      "\\begin{{table}}\n\\centering\n\\caption{{{}}}\n\\begin{{tabular}}{{{}}}\n\\toprule\n{} "
      "\\\\\n\\midrule\n"
      "{}\\bottomrule\n\\end{{tabular}}\n\\end{{table}}\n\n",
      escaped(table.title), columns, head, body);
}

json value_of(const Cell& cell) {
  return cell.kind == Cell::Kind::number ? json(cell.spread.median)
         : cell.kind == Cell::Kind::word ? json(cell.word)
                                         : json();
}

}  // namespace

std::string report_latex(const Report& report) {
  std::string text = fmt::format("% {}. \\usepackage{{booktabs}}\n", escaped(report.title));
  for (const auto& [name, value] : report.facts) text += fmt::format("% {}: {}\n", name, value);
  bool any = false;
  for (const Part& part : report.parts)
    if (const auto* table = std::get_if<Table>(&part); table && (any = true)) text += table_latex(*table);
  return any ? text : text + table_latex(report.measurements);
}

json report_t4(const Report& report) {
  json results = json::array();
  const Table& table = report.measurements;
  for (const auto& row : table.rows) {
    json configuration = json::object(), measured = json::array(), runs = json::array();
    std::string problem;
    for (std::size_t i = 0, tells_apart = 1; i < row.size(); ++i) {
      const Column& column = table.columns[i];
      tells_apart = tells_apart && column.name != "time";
      if (column.name == "problem") problem = row[i].word;
      if (column.name == "time") runs = row[i].spread.runs;
      if (row[i].kind == Cell::Kind::none) continue;
      if (tells_apart)
        configuration[plain_name(column)] = value_of(row[i]);
      else if (row[i].kind != Cell::Kind::word)
        measured.push_back({{"name", column.name}, {"value", row[i].spread.median}, {"unit", column.unit}});
    }
    results.push_back({{"configuration", configuration},
                       {"objectives", {"time"}},
                       {"times", {{"runtimes", runs}}},
                       {"invalidity", problem.empty() ? "correct" : "runtime"},
                       {"correctness", problem.empty() ? 1 : 0},
                       {"measurements", measured}});
  }
  return {{"schema_version", "1.0.0"}, {"results", results}};
}

}  // namespace sundog
