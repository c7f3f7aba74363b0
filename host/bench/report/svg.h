// Plots as SVG text, to stand in a page whose style sheet (report_html.cpp) names their colours: c0..c7 are
// the curves' classes. Internal to the report writers.
#pragma once
#include <string>

#include "bench/report/report.h"

namespace sundog {

/// Text with < > & " escaped.
std::string escape_html(const std::string& text);

std::string svg(const CurvePlot& plot);
std::string svg(const BarPlot& plot);
std::string svg(const HeatMap& map);

/// Round numbers from 0 that cover [0, most] in about `count` steps.
std::vector<double> axis_ticks(double most, int count = 5);

}  // namespace sundog
