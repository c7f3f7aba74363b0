// A benchmark's results as plain values. A benchmark fills a Report; the writers below turn any Report into
// text, JSON, CSV or a page, and know no benchmark.
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
};

/// Every row has a cell for each column.
struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

/// "time [ms]" as a name that programs like: "time_ms".
std::string plain_name(const Column& column);

/// Whether the column has a word in some row.
bool is_word_column(const Table& table, std::size_t column);

/// A cell and its column.
struct Field {
  std::string name, unit;
  Cell cell;
};

/// Appends a row; a name that the table has no column for gets one.
void add_row(Table& table, const std::vector<Field>& fields);

struct CurvePoint {
  double x = 0;
  Spread y;
};
struct Curve {
  std::string name;
  std::vector<CurvePoint> points;  // ascending x
};
/// Curves over an axis that counts in powers of two; with `ideal` the line y = x is drawn too. With
/// `logarithmic` both axes have powers of ten, and all values are above 0.
struct CurvePlot {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  bool ideal = false, logarithmic = false;
};

struct Bar {
  std::string label;
  Spread value;
  std::string note;  // drawn behind the bar
};
/// Lying bars with their spread; as `ratios` points about 1 on a logarithmic axis, in a terminal too.
struct BarPlot {
  std::string title, unit;
  std::vector<Bar> bars;
  bool ratios = false;
};

/// Times in two dimensions. values[row][column]; empty: not measured. With `has_best` the least is outlined.
struct HeatMap {
  std::string title, unit, x_label, y_label;
  std::vector<std::string> columns, rows;
  std::vector<std::vector<std::optional<double>>> values;
  bool has_best = false;
};

using Part = std::variant<Table, CurvePlot, BarPlot, HeatMap>;

using Facts = std::vector<std::pair<std::string, std::string>>;

struct Report {
  std::string name;                // "threads": of `sundog bench threads`
  std::string title;               // the page's headline
  Facts facts;                     // device, driver, scene...: what the figures hold for
  std::vector<std::string> notes;  // a sentence each: how it was measured, what failed
  std::vector<Part> parts;         // what a person reads, in this order
  Table measurements;              // tidy: a row a measurement, for other programs
  std::vector<MeasuredWay> ways;   // with every raw run
  Facts environment;               // variables that drivers and sundog read
  Table devices, scenes;           // what was measured, for other programs
  bool complete = true;            // false: the bench still runs, or was interrupted
  bool times_frames = false;       // of the scenes' sizes
};

/// Its time; nothing where it has none.
Cell milliseconds(const MeasuredWay& way);

/// Appends a row for people, with the way's problem where it has one.
void add_row(Table& table, std::vector<Field> row, const MeasuredWay& way);

/// Adds a way and its row of measurements: `key`, then what every bench has (time, runs, cores, load,
/// problem), then `more`.
void add_measured(Report& report, const MeasuredWay& way, std::vector<Field> key,
                  const std::vector<Field>& more = {});

/// Facts, the tables among the parts (the measurements when there are none), notes.
std::string report_text(const Report& report);

/// docs/reference/bench-reports.md describes it; a Spread is an object of median, low, high, min, max and the
/// runs.
nlohmann::json report_json(const Report& report);

/// The measurements alone, as RFC 4180 has it, with one line of names.
std::string report_csv(const Report& report);

/// One page that needs nothing else: tables and SVG plots, in the reader's light or dark colours, and fit for
/// print.
std::string report_html(const Report& report);

/// The tables, with booktabs.
std::string report_latex(const Report& report);

/// Plots as files, for a column of 88 mm with letters of 8 points.
std::vector<std::string> report_svgs(const Report& report);

/// The measurements in the T4 format of Kernel Tuner and others (results-schema.json, 1.0.0): what stands
/// before the time in a row is the configuration.
nlohmann::json report_t4(const Report& report);

/// A number with about three digits that count: "0.0123", "4.57", "12.3", "1234".
std::string number_text(double value);

/// "12.3 [11.9, 12.8]": the median and, if it has one, its interval. Empty for nothing.
std::string cell_text(const Cell& cell);

}  // namespace sundog
