// Writes a report as one page without scripts or other files, in light or dark colours as the reader prefers,
// and on paper always dark on white.
#include <fmt/format.h>

#include "bench/report/svg.h"

namespace sundog {
namespace {

constexpr const char* style = R"(
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 860px; padding: 32px 24px 64px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.6em; line-height: 1.25; margin: 0 0 16px; } h2 { font-size: 1.1em; margin: 36px 0 8px; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 16px; margin: 0; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
li, h1, h2 { overflow-wrap: anywhere; }
figure { margin: 0; } svg { display: block; width: 100%; height: auto;}
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 9px; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th { color: var(--soft); font-weight: 600; background: var(--fill); white-space: normal; vertical-align: bottom; } th.w, td.w { text-align: left; }
th small { font-weight: 400; display: block; } td small { display: block; color: var(--soft); white-space: normal; min-width: 12em; } td.w { white-space: normal; }
/* On a phone: plots no smaller than their letters can be read, they scroll in their box as tables do. */
@media screen and (max-width: 640px) { body { padding: 20px 14px 40px; } h1 { font-size: 1.4em; } th, td { padding: 4px 6px; font-size: 14px; }
  dl { display: block; } dd { margin-bottom: 6px; } figure { overflow-x: auto; } svg { min-width: calc(.85 * var(--width)); } }
ul { padding-left: 20px; color: var(--soft); } details { margin-top: 36px; } summary { cursor: pointer; color: var(--soft); }
@media print { body { font-size: 10pt; padding: 0; } .scroll { overflow-x: visible; } th, td { padding: 3px 6px; font-size: 8.5pt; } figure, tr, h2 { break-inside: avoid; } h2 { break-after: avoid; }
  details:not([open]) { display: none; } }
)";

/// `raw`: lists every run below the median.
std::string cell_html(const Cell& cell, bool raw) {
  std::string text = escape_html(cell_text(cell));
  if (!raw || cell.kind != Cell::Kind::spread || cell.spread.runs.empty()) return text;
  std::vector<std::string> runs;
  for (const double run : cell.spread.runs) runs.push_back(number_text(run));
  return text + fmt::format("<small>{}</small>", fmt::join(runs, " "));
}

std::string table_html(const Table& table, bool raw = false) {
  std::string head, body;
  std::vector<const char*> kinds;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    kinds.push_back(is_word_column(table, i) ? " class=\"w\"" : "");
    const Column& column = table.columns[i];
    const std::string unit = column.unit.empty() ? "" : " <small>" + escape_html(column.unit) + "</small>";
    head += fmt::format("<th{}>{}{}</th>", kinds[i], escape_html(column.name), unit);
  }
  for (const auto& row : table.rows) {
    body += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      body += fmt::format("<td{}>{}</td>", kinds[i], cell_html(row[i], raw));
    body += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"scroll\"><table><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n", head,
      body);
}

std::string part_html(const Part& part) {
  return std::visit(
      [](const auto& shown) {
        std::string content;
        if constexpr (std::is_same_v<std::decay_t<decltype(shown)>, Table>)
          content = table_html(shown);
        else
          content = "<figure>" + svg(shown) + "</figure>\n";
        return (shown.title.empty() ? "" : "<h2>" + escape_html(shown.title) + "</h2>\n") + content;
      },
      part);
}

}  // namespace

std::string escape_html(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string report_html(const Report& report) {
  std::string body = fmt::format("<h1>{}</h1>\n<dl>\n", escape_html(report.title));
  for (const auto& [name, value] : report.facts)
    body += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(name), escape_html(value));
  body += "</dl>\n";
  for (const Part& part : report.parts) body += part_html(part);
  if (!report.notes.empty()) body += "<h2>How it was measured</h2>\n<ul>\n";
  for (const std::string& note : report.notes) body += "<li>" + escape_html(note) + "</li>\n";
  if (!report.notes.empty()) body += "</ul>\n";
  body += fmt::format("<details><summary>All {} measurements</summary>\n{}</details>\n",
                      report.measurements.rows.size(), table_html(report.measurements, true));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\">\n<title>{}</title>\n<style>{}{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      escape_html(report.title), plot_style(Place::page), style, body);
}

}  // namespace sundog
