// Reports: the same figures as text, JSON, CSV and a page.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

#include "bench/report/machine.h"
#include "bench/report/report.h"
#include "bench/report/samples.h"
#include "bench/report/svg.h"
#include "catch.h"
#include "occurrences.h"

using namespace sundog;

namespace {

Report small_report() {
  Report report;
  report.name = "threads";
  report.title = "Times & <more>";
  report.facts = {{"device", "a \"fast\" one"}, {"driver", "1"}, {"driver", "2"}};
  report.notes = {"Median of 3."};
  report.measurements = {"",
                         {{"scene", "", true}, {"time", "ms"}, {"runs", ""}},
                         {{"ice, hollow", spread({13, 12, 12.345}), 3.0}, {"say \"x\"", Cell(), Cell()}}};
  return report;
}

}  // namespace

TEST_CASE("a device is called by its place and its name without marks and versions") {
  CHECK(device_title("1:0 NVIDIA CUDA / NVIDIA H200", "NVIDIA H200") == "1:0 NVIDIA H200");
  CHECK(device_title("0:0/2@1 x / y", "pthread-skylake-avx512-Intel(R) Xeon(R) CPU E5 @ 2.20GHz") ==
        "0:0/2@1 pthread-skylake-avx512-Intel ...");
  CHECK(device_title("2:0 r / l", "llvmpipe (LLVM 15.0.6, 512 bits)") == "2:0 llvmpipe");
  CHECK(device_title("2:1 r / l", "Intel(R) Arc(TM) A770 Graphics (DG2)") == "2:1 Intel Arc A770 Graphics");
}

TEST_CASE("numbers keep about three digits that count") {
  CHECK(number_text(0) == "0");
  CHECK(number_text(7) == "7");
  CHECK(number_text(1234.5) == "1234");
  CHECK(number_text(99.96) == "100");
  CHECK(number_text(12.345) == "12.3");
  CHECK(number_text(9.996) == "10.0");
  CHECK(number_text(1.0) == "1");
  CHECK(number_text(1.25) == "1.25");
  CHECK(number_text(0.5) == "0.500");
  CHECK(number_text(0.01234) == "0.0123");
  CHECK(number_text(-2.5) == "-2.50");
  CHECK(cell_text(Spread{10.04, 9, 11}) == "10.0 [9, 11]");
  CHECK(cell_text(spread({4, 4})) == "4 [4, 4]");
  CHECK(cell_text(spread({318})) == "318");  // a single run has no interval
  CHECK(cell_text(Spread{1, 1, 1}) == "1");
  CHECK(cell_text(Cell()).empty());
}

TEST_CASE("a CSV has a line of names, four columns for a spread with every run, and quotes what needs it") {
  CHECK(report_csv(small_report()) ==
        "scene,time_ms,time_ms_min,time_ms_max,time_ms_runs,runs\r\n"
        "\"ice, hollow\",12.345,12,13,13 12 12.345,3\r\n"
        "\"say \"\"x\"\"\",,,,,\r\n");
}

TEST_CASE("JSON holds facts and a row a measurement, with null for what was not measured") {
  const nlohmann::json json = report_json(small_report());
  CHECK(json.at("schema") == 2);
  CHECK(json.at("complete") == true);
  CHECK(json.at("bench") == "threads");
  CHECK(json.at("facts").at("device") == "a \"fast\" one");
  CHECK(json.at("facts").at("driver") == nlohmann::json({"1", "2"}));  // one of several devices each
  CHECK(json.at("notes").at(0) == "Median of 3.");
  const auto& rows = json.at("measurements");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].at("time_ms").at("median") == 12.345);
  CHECK(rows[0].at("time_ms").at("max") == 13);
  CHECK(rows[0].at("time_ms").at("runs") ==
        nlohmann::json({13, 12, 12.345}));  // in the order they were taken
  CHECK(rows[0].at("runs") == 3);
  CHECK(rows[1].at("time_ms").is_null());
}

TEST_CASE("text shows the parts' tables, or the measurements where there are none") {
  Report report = small_report();
  CHECK_THAT(report_text(report), ContainsSubstring("time [ms]") && ContainsSubstring("12.3 [12, 13]") &&
                                      ContainsSubstring("device  a \"fast\" one"));
  report.parts = {Table{"Best", {{"size", ""}}, {{64.0}}}};
  CHECK_THAT(report_text(report), ContainsSubstring("Best\n") && !ContainsSubstring("time [ms]"));
}

TEST_CASE("columns of a text are aligned, whatever bytes their letters take") {
  Report report;
  report.measurements = {"", {{"a", ""}, {"b", ""}}, {{"x ±1", 1.0}, {"xxxx", 22.0}}};
  const std::string text = report_text(report);
  CHECK_THAT(text, ContainsSubstring("  x ±1   1\n") && ContainsSubstring("  xxxx  22\n"));
}

TEST_CASE("a page stands alone: nothing to load, everything escaped, plots and measurements in it") {
  Report report = small_report();
  const Bar bar{"<bar>", spread({5, 4, 6}), "40 %"};
  report.parts = {
      CurvePlot{
          "Curves <1>", "threads", "times as fast", {{"a & b", {{1, {1, 1, 1}}, {4, {3, 2, 4}}}}}, true},
      BarPlot{"Bars", "ms", {bar}},
      HeatMap{"Heat", "ms", "x", "y", {"1", "2"}, {"1"}, {{4.0, std::nullopt}}}};
  const std::string page = report_html(report);
  CHECK(page.starts_with("<!DOCTYPE html>"));
  CHECK_THAT(page, ContainsSubstring("<title>Times &amp; &lt;more&gt;</title>") &&
                       ContainsSubstring("&lt;bar&gt;") && ContainsSubstring("Curves &lt;1&gt;") &&
                       ContainsSubstring("a &amp; b") && ContainsSubstring("All 2 measurements") &&
                       ContainsSubstring("prefers-color-scheme: dark") && ContainsSubstring("@media print"));
  for (const char* outside : {"<script", "https:", "src=", "href=", "url("})
    CHECK(occurrences(page, outside) == 0);
  // A plot that is cut out of the page is a file of its own.
  CHECK(occurrences(page, "http:") == 3);
  CHECK(occurrences(page, "<svg xmlns=\"http://www.w3.org/2000/svg\"") == 3);
  for (const std::string& plot : {svg(CurvePlot{}), svg(BarPlot{}), svg(HeatMap{})})
    CHECK_THAT(plot, ContainsSubstring("<style>") && ContainsSubstring("--ink: #1c2126"));
  // On a narrow screen plots keep a width at which they can be read, and scroll like tables.
  CHECK(occurrences(page, "style=\"--width:") == 3);
  CHECK_THAT(page, ContainsSubstring("max-width: 640px") && ContainsSubstring("calc(.85 * var(--width))"));
  CHECK(occurrences(page, "</svg>") == 3);
  CHECK_THAT(page,
             ContainsSubstring("12.3 [12, 13]<small>13 12 12.3</small>"));  // raw runs, in the details alone
  CHECK(occurrences(page, "class=\"cell") == 1);  // what was not measured has no cell
}

TEST_CASE("LaTeX has the tables with booktabs, intervals in them, and every special sign escaped") {
  Report report = small_report();
  report.measurements.title = "50 % of_all";
  const std::string text = report_latex(report);
  CHECK_THAT(text, ContainsSubstring("\\caption{50 \\% of\\_all; intervals in brackets}") &&
                       ContainsSubstring("\\begin{tabular}{lrr}") &&
                       ContainsSubstring("scene & time (ms) & runs \\\\") &&
                       ContainsSubstring("ice, hollow & 12.3 {\\footnotesize[12, 13]} & 3 \\\\"));
  for (const char* rule : {"\\toprule", "\\midrule", "\\bottomrule"}) CHECK(occurrences(text, rule) == 1);
  report.parts = {Table{"Best", {{"size", ""}}, {{"[a]"}}}};
  CHECK_THAT(report_latex(report), ContainsSubstring("{[}a]") && !ContainsSubstring("hollow"));
  report.parts = {Table{"T", {{"of even rays", "%"}, {"error x sqrt(samples)", ""}}, {{"a", 1.0}}}};
  report.scenes = {"", {{"width", "pixels"}, {"height", "pixels"}}, {{320.0, 240.0}, {320.0, 240.0}}};
  report.notes = {"Two\nlines."};
  report.times_frames = true;
  CHECK_THAT(report_latex(report),
             ContainsSubstring("\\caption{T; $320 \\times 240$ pixels}") &&
                 ContainsSubstring("\\shortstack[l]{of even\\\\rays (\\%)} & "
                                   "\\shortstack[r]{error $\\times$\\\\$\\sqrt{n}$} \\\\\n") &&
                 ContainsSubstring("% Two\n% lines.\n"));
}

TEST_CASE("plots for a paper's column are files of 88 mm, half as wide as those of a page") {
  Report report;
  const Bar bar{"a label that is much longer than a column has room for", spread({5, 4, 6}), "a note"};
  report.parts = {Table{}, CurvePlot{"", "", "", {{"a", {{1, {1, 1, 1}}}}}}, BarPlot{"", "ms", {bar}},
                  HeatMap{}};
  const std::vector<std::string> plots = report_svgs(report);
  REQUIRE(plots.size() == 3);
  for (const std::string& plot : plots)  // programs that make PDFs of them know no variables
    CHECK_THAT(plot, ContainsSubstring(" width=\"88mm\"") && !ContainsSubstring("var(") &&
                         ContainsSubstring("svg .l.c0 { stroke: #0072b2; }"));
  for (std::size_t i = 0; i < 2; ++i) CHECK_THAT(plots[i], ContainsSubstring("viewBox=\"0 0 400 "));
  CHECK_THAT(plots[1], !ContainsSubstring("column has room for</text>") && !ContainsSubstring("a note"));
}

TEST_CASE("a legend stands below its plot and wraps, so that no name is cut; one curve needs none") {
  CurvePlot plot{"", "", "", {{"one", {{1, {1, 1, 1}}}}}};
  CHECK(occurrences(svg(plot, Place::column), "class=\"name\"") == 0);
  for (int i = 0; i < 4; ++i) plot.curves.push_back({"1024 x 1024, fixed", {}});
  const std::string text = svg(plot, Place::column);
  // Names of 18 letters take 60 + 18 * 7.2 pixels each: one of them beside "one", then a line each two.
  CHECK(occurrences(text, "class=\"name\"") == 5);
  CHECK(occurrences(text, "class=\"name\" x=\"56.0\" y=\"394\">one<") == 1);
  CHECK(occurrences(text, "x=\"56.0\" y=\"416\">1024 x 1024, fixed<") == 1);
  CHECK_THAT(text, ContainsSubstring("viewBox=\"0 0 400 446\""));
}

TEST_CASE("ratios are drawn about 1, in text too") {
  Report report;
  report.parts = {
      BarPlot{"r", "ratio", {{"faster", {0.5, 0.4, 0.6}, "faster"}, {"alike", {1, 0.9, 1.2}, ""}}, true}};
  const std::string text = report_text(report);
  const std::size_t line = text.find("faster  ");
  REQUIRE(line != std::string::npos);
  CHECK(text.find("\u25cf", line) < text.find("\u2502", line));  // the point is left of 1
  CHECK(occurrences(svg(std::get<BarPlot>(report.parts[0])), "class=\"bar\"") == 2);
}

TEST_CASE("bars in a paper's column are labelled with the words that differ") {
  const BarPlot plot{
      "",
      "ms",
      {{"ice on 0:0 Some Processor, even, a", {}, ""}, {"ice on 0:0 Some Processor, even, b", {}, ""}}};
  CHECK_THAT(svg(plot, Place::column), ContainsSubstring(">a</text>") && ContainsSubstring(">b</text>"));
  const BarPlot devices{"", "ms", {{"0:0 Some Processor of a kind", {}, ""}, {"0:1 Other", {}, ""}}};
  CHECK_THAT(svg(devices, Place::column),
             ContainsSubstring(">0:0 Some Processor</text>") && ContainsSubstring(">0:1 Other</text>"));
}

TEST_CASE("the axis of ratios holds their intervals") {
  Report report;
  report.parts = {BarPlot{"r", "ratio", {{"alike", {1, 0.5, 1.2}, ""}}, true}};
  // exp(-1.1 ln 2) = 0.467: a tenth of room beside the interval's end.
  CHECK_THAT(svg(std::get<BarPlot>(report.parts[0])), ContainsSubstring(">0.467</text>"));
  CHECK_THAT(report_text(report), ContainsSubstring("0.467"));
}

TEST_CASE("T4 has a result a row, whose configuration has the parameters alone") {
  const nlohmann::json t4 = report_t4(small_report());
  CHECK(t4.at("schema_version") == "1.0.0");
  const auto& results = t4.at("results");
  REQUIRE(results.size() == 2);
  CHECK(results[0].at("configuration") == nlohmann::json({{"scene", "ice, hollow"}}));
  CHECK(results[0].at("times").at("runtimes") == nlohmann::json({13, 12, 12.345}));
  CHECK(results[0].at("invalidity") == "correct");
  CHECK(results[0].at("measurements")[0] ==
        nlohmann::json({{"name", "time"}, {"value", 12.345}, {"unit", "ms"}}));
  // Results that a bench has beside the time are measurements, wherever they stand.
  Report report;
  add_result(report, {{"scene", "", "ice"}, {"chains", "", Cell()}}, {{"rate", "Gop/s", 5.0}});
  add_result(report, {{"scene", "", "ice"}, {"chains", "", 8.0}}, {{"rate", "Gop/s", 7.0}});
  const nlohmann::json more = report_t4(report).at("results");
  CHECK(more[0].at("configuration") == nlohmann::json({{"scene", "ice"}}));
  CHECK(more[1].at("configuration") == nlohmann::json({{"scene", "ice"}, {"chains", 8.0}}));
  CHECK(more[1].at("measurements") ==
        nlohmann::json::array({{{"name", "rate"}, {"value", 7.0}, {"unit", "Gop/s"}}}));
}

TEST_CASE("printed tables have energy where it is known, and no empty columns where it is not") {
  MeasuredWay way;
  way.name = "a";
  for (const double seconds : {1.0, 3.0}) way.runs.push_back({seconds, 1, 0, 0, ""});
  Report report;
  Table table{"Times", {}, {}};
  add_row(table, {{"way", "", "plain"}}, way);
  CHECK(table.columns.size() == 1);
  for (Run& run : way.runs) run.joules = 40 * run.seconds, run.watts = 40;
  add_row(table, {{"way", "", "counted"}}, way);
  report.parts = {table};
  for (const auto& [text, head, row] :
       {std::tuple(report_text(report), "energy [J]  power [W]", "counted          80         40"),
        std::tuple(report_latex(report), "energy\\\\(J)} & power (W)", "counted & 80 & 40"),
        std::tuple(report_html(report), "<th>energy <small>J</small></th><th>power <small>W</small></th>",
                   "<td class=\"w\">counted</td><td>80</td><td>40</td>")})
    CHECK_THAT(text, ContainsSubstring(head) && ContainsSubstring(row));
}

TEST_CASE("points whose x was measured have a horizontal interval, which the axis holds") {
  CurvePlot plot{"", "ms", "error", {{"a", {{4, {1, 1, 1}}, {8, {0.5, 0.5, 0.5}, {6, 16}}}}}, false, true};
  // The axis from 2 to 20: x = 64 + log(x / 2) / log(10) * 672.
  CHECK_THAT(svg(plot), ContainsSubstring("x1=\"384.6\" x2=\"670.9\""));
  plot.curves[0].points[1].x_interval = {};
  CHECK(occurrences(svg(plot), "<line class=\"l c0\"") == 2);
}

TEST_CASE("plots of nothing, of one point and of zeros are drawn without a number that is none") {
  Bar zero;
  zero.label = "zero";
  for (const std::string& text :
       {svg(CurvePlot{}), svg(CurvePlot{"", "", "", {{"one", {{4, {}}}}}, true}), svg(BarPlot{}),
        svg(BarPlot{"", "", {zero}}), svg(HeatMap{}), svg(HeatMap{"", "", "", "", {"a"}, {"b"}, {{0.0}}})}) {
    CAPTURE(text);
    CHECK(occurrences(text, "nan") == 0);
    CHECK(occurrences(text, "inf") == 0);
    CHECK(text.ends_with("</svg>"));
  }
}

TEST_CASE(
    "the line of ideal speed-up goes to the border of its plot, all of it where the curves are not far "
    "below") {
  // Where the line ends: x from 64 (1 thread) to 736 (8 threads), y from 16 (the top).
  const auto end = [](double measured) {
    const std::string text =
        svg(CurvePlot{"", "", "", {{"a", {{1, {1, 1, 1}}, {8, {measured, 1, measured}}}}}, true});
    const std::size_t start = text.find("class=\"ideal\" points=\""), last = text.find(" \"/>", start);
    const std::size_t space = text.rfind(' ', last - 1) + 1;
    return text.substr(space, last - space);
  };
  CHECK(end(8) == "736.0,16.0");
  CHECK(end(5) == "736.0,16.0");
  CHECK(end(2) == "288.0,16.0");
}

TEST_CASE("an axis has round ticks from 0 that cover what is shown") {
  for (const double most : {0.0031, 0.7, 1.0, 9.99, 16.0, 1234.0}) {
    CAPTURE(most);
    const std::vector<double> ticks = axis_ticks(most);
    CHECK(ticks.front() == 0);
    CHECK(ticks.back() >= most * (1 - 1e-9));
    CHECK(ticks.back() <= most * 1.5);
    CHECK((ticks.size() >= 3 && ticks.size() <= 9));
  }
  CHECK(axis_ticks(1) == std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0});
}
