// Writes reports for papers (LaTeX with booktabs) and for other tuners (the T4 format).
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

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
                                                    {'<', "\\textless{}"},
                                                    {'>', "\\textgreater{}"},
                                                    {'|', "\\textbar{}"},
                                                    {'*', "{*}"},
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

/// Breaks the head into lines about as wide as a figure, so that a table of eight columns fits an article.
std::string head_latex(const Column& column, char side) {
  constexpr std::size_t most_letters = 9;
  static const std::map<std::string, const char*> symbols{{"x", "$\\times$"},
                                                          {"sqrt(samples)", "$\\sqrt{n}$"}};
  std::istringstream words(column.name + (column.unit.empty() ? "" : " (" + column.unit + ")"));
  std::string text, word;
  std::size_t letters = 0;  // of the last line
  bool broken = false;
  while (words >> word) {
    const bool fits = letters + 1 + word.size() <= most_letters;
    if (letters > 0) text += fits ? " " : "\\\\";
    broken = broken || (letters > 0 && !fits);
    letters = word.size() + (letters > 0 && fits ? letters + 1 : 0);
    const auto symbol = symbols.find(word);
    text += symbol == symbols.end() ? escaped(word) : symbol->second;
  }
  return broken ? fmt::format("\\shortstack[{}]{{{}}}", side, text) : text;
}

/// The images' size if all have the same, otherwise empty.
std::string image_size(const Table& scenes) {
  const auto column = [&](const char* name) {
    return std::ranges::find(scenes.columns, name, &Column::name);
  };
  const auto width = column("width") - scenes.columns.begin(),
             height = column("height") - scenes.columns.begin();
  std::set<std::string> sizes;
  for (const auto& row : scenes.rows)
    sizes.insert(fmt::format("${} \\times {}$ pixels", cell_text(row.at(static_cast<std::size_t>(width))),
                             cell_text(row.at(static_cast<std::size_t>(height)))));
  return sizes.size() == 1 ? *sizes.begin() : "";
}

std::string caption_of(const Table& table, const Report& report) {
  bool has_brackets = false, has_ranges = false;
  for (const auto& row : table.rows)
    for (const Cell& cell : row)
      if (cell.kind == Cell::Kind::spread && has_interval(cell.spread)) {
        has_brackets = true;
        has_ranges = has_ranges || cell.spread.runs.size() < fewest_for_interval;
      }
  std::string caption = escaped(table.title);
  const auto add = [&](const std::string& text) {
    caption += (caption.empty() || text.empty() ? "" : "; ") + text;
  };
  if (report.times_frames) add(image_size(report.scenes));
  if (has_brackets) add(has_ranges ? "intervals in brackets" : "95 \\% intervals in brackets");
  return caption;
}

/// The text as LaTeX comment lines.
std::string comment(const std::string& text) {
  std::string lines = "% ";
  for (const char c : text) lines += c == '\n' ? "\n% " : std::string(1, c);
  return lines + "\n";
}

std::string table_latex(const Table& table, const std::string& caption) {
  std::string columns, head, body;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    columns += is_word_column(table, i) ? 'l' : 'r';
    head += (i ? " & " : "") + head_latex(table.columns[i], columns.back());
  }
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) body += (i ? " & " : "") + cell_latex(row[i]);
    body += " \\\\\n";
  }
  return fmt::format(
      "\\begin{{table}}\n\\centering\\small\\tabcolsep=4pt\n\\caption{{{}}}\n"
      "\\begin{{tabular}}{{{}}}\n\\toprule\n{} \\\\\n\\midrule\n"
      "{}\\bottomrule\n\\end{{tabular}}\n\\end{{table}}\n\n",
      caption, columns, head, body);
}

json value_of(const Cell& cell) {
  return cell.kind == Cell::Kind::number ? json(cell.spread.median)
         : cell.kind == Cell::Kind::word ? json(cell.word)
                                         : json();
}

}  // namespace

std::string report_latex(const Report& report) {
  std::string text = comment(report.title + ". \\usepackage{booktabs}");
  text += comment("A wide table across a paper's two columns: write table* for table, at its begin and end.");
  for (const auto& [name, value] : report.facts) text += comment(fmt::format("{}: {}", name, value));
  for (const std::string& note : report.notes) text += comment(note);
  std::string tables;
  const auto add = [&](const Table& table) { tables += table_latex(table, caption_of(table, report)); };
  for (const Part& part : report.parts)
    if (const auto* table = std::get_if<Table>(&part)) add(*table);
  if (tables.empty()) add(report.measurements);
  return text + tables;
}

json report_t4(const Report& report) {
  json results = json::array();
  const Table& table = report.measurements;
  for (const auto& row : table.rows) {
    json configuration = json::object(), measured = json::array(), runs = json::array();
    std::string problem;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Column& column = table.columns[i];
      if (column.name == "problem") problem = row[i].word;
      if (column.name == "time") runs = row[i].spread.runs;
      if (row[i].kind == Cell::Kind::none) continue;
      if (column.is_parameter)
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
