// Draws plots as SVG text with their own style, for a page or a file of their own. c0..c7 are the curves'
// classes. Internal to the report writers.
#pragma once
#include <string>

#include "bench/report/report.h"

namespace sundog {

/// Text with < > & " escaped.
std::string escape_html(const std::string& text);

/// Assumed width of a system font's letter, to leave room for labels.
constexpr double letter = 7.2;

/// The place of a plot: in a page, or in a paper's column, which is half as wide.
enum class Place { page, column };

/// The CSS rules of all plots. A page gets variables for light, dark and print colours, a column the print
/// colours as literals.
std::string plot_style(Place place);

/// The opening tag and style of a plot.
std::string svg_begin(Place place, double width, double height, const std::string& title,
                      const std::string& more_style = "");

std::string svg(const CurvePlot& plot, Place place = Place::page);
std::string svg(const BarPlot& plot, Place place = Place::page);
std::string svg(const HeatMap& map, Place place = Place::page);

/// Round numbers from 0 that cover [0, most] in about five steps.
std::vector<double> axis_ticks(double most);

}  // namespace sundog
