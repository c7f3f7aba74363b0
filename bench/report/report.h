// A benchmark's results as plain values. A benchmark fills a Report; the writers below turn any Report into
// text, JSON, CSV or a page, independently of the benchmark.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bench/report/samples.h"

namespace sundog {

/// Nothing, a word, a number (`spread.median`), or a number measured several times.
struct Cell {
  enum class Kind { none, word, number, spread } kind = Kind::none;
  std::string word;
  Spread spread;

  Cell() = default;
  Cell(std::string text) : kind(Kind::word), word(std::move(text)) {}
  Cell(const char* text) : kind(Kind::word), word(text) {}
  Cell(double number) : kind(Kind::number), spread{number, number, number} {}
  Cell(const Spread& measured) : kind(Kind::spread), spread(measured) {}
  template <class T>
  Cell(const std::optional<T>& known) {
    if (known) *this = Cell(*known);
  }
};

/// `unit` may be empty. A Spread takes four columns of a CSV: name, name_min, name_max, name_runs.
struct Column {
  std::string name, unit;
  bool is_parameter = false;  // of measurements: chosen before a run, not measured
};

/// Every row has a cell for each column.
struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

/// "time [ms]" as an identifier: "time_ms".
std::string plain_name(const Column& column);

/// Whether the column has a word in any row.
bool is_word_column(const Table& table, std::size_t column);

/// A cell and its column.
struct Field {
  std::string name, unit;
  Cell cell;
};

/// Appends a row, and a column for each new name.
void add_row(Table& table, const std::vector<Field>& fields);

struct CurvePoint {
  double x = 0;
  Spread y;
  Interval x_interval = {};  // drawn if its bounds differ
};
struct Curve {
  std::string name;
  std::vector<CurvePoint> points;  // ascending x
};
/// Curves over an x axis in powers of two. `ideal`: draws the line y = x too. `logarithmic`: both axes are in
/// powers of ten, and all values are above 0.
struct CurvePlot {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  bool ideal = false, logarithmic = false;
};

struct Bar {
  std::string label;
  Spread value;
  std::string note;  // drawn after the bar
};
/// Horizontal bars with their spread. `ratios`: points around 1 on a logarithmic axis, in a terminal too.
struct BarPlot {
  std::string title, unit;
  std::vector<Bar> bars;
  bool ratios = false;
};

/// Times in two dimensions. values[row][column]; empty: not measured. `has_best`: outlines the least.
struct HeatMap {
  std::string title, unit, x_label, y_label;
  std::vector<std::string> columns, rows;
  std::vector<std::vector<std::optional<double>>> values;
  bool has_best = false;
};

using Part = std::variant<Table, CurvePlot, BarPlot, HeatMap>;

using Facts = std::vector<std::pair<std::string, std::string>>;

struct Report {
  std::string name;                // the bench's, such as "threads"
  std::string title;               // the page's headline
  Facts facts;                     // device, driver, scene...: the conditions of the measurements
  std::vector<std::string> notes;  // a sentence each: the method, and failures
  std::vector<Part> parts;         // for people, in this order
  Table measurements;              // tidy: one row per measurement, for other programs
  std::vector<MeasuredWay> ways;   // with every raw run
  Facts environment;               // variables that drivers and sundog read
  Table devices, scenes;           // measured ones, for other programs
  bool complete = true;            // false: the bench is running or was interrupted
  bool times_frames = false;       // of the scenes' sizes, which captions then give
};

/// The way's time; nothing if it has none.
Cell milliseconds(const MeasuredWay& way);

/// Appends a row for people, with the way's energy and its problem as far as it has them.
void add_row(Table& table, std::vector<Field> row, const MeasuredWay& way);

/// The columns of every bench: time, runs, cores, load, energy, problem.
std::vector<Field> measured_fields(const MeasuredWay& way);

/// Appends a row of measurements; the columns of `key` are parameters.
void add_result(Report& report, const std::vector<Field>& key, std::vector<Field> results);

/// Adds a way and its row of measurements: the parameters `key`, then measured_fields(), then `more`.
void add_measured(Report& report, const MeasuredWay& way, const std::vector<Field>& key,
                  const std::vector<Field>& more = {});

/// Facts, the tables among the parts (the measurements if there are none), notes.
std::string report_text(const Report& report);

/// docs/reference/bench-reports.md describes it; a Spread is an object of median, low, high, min, max and the
/// runs.
nlohmann::json report_json(const Report& report);

/// The measurements alone, by RFC 4180, with a header line.
std::string report_csv(const Report& report);

/// One self-contained page: tables and SVG plots, in light or dark colours as the reader prefers, and
/// printable.
std::string report_html(const Report& report);

/// The tables for LaTeX, with booktabs.
std::string report_latex(const Report& report);

/// Each plot as an SVG file for a column of 88 mm, with letters of 8 points.
std::vector<std::string> report_svgs(const Report& report);

/// The measurements in the T4 format of Kernel Tuner and others (results-schema.json, 1.0.0): the parameters
/// are the configuration.
nlohmann::json report_t4(const Report& report);

/// A number with about three significant digits: "0.0123", "4.57", "12.3", "1234".
std::string number_text(double value);

/// "12.3 [11.9, 12.8]": the median and, if it has one, its interval. Empty for an empty cell.
std::string cell_text(const Cell& cell);

}  // namespace sundog
