// Draws curves, each with its own color, dash and marker, so that they differ in black and white too.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/report/svg.h"

namespace sundog {
namespace {

constexpr double height = 380, left = 64, right = 24, top = 16, bottom = 56;  // without the legend
constexpr double plot_height = height - top - bottom;
constexpr int styles = 8;

struct Axes {
  double width = 760;              // of the picture
  double low = 0, high = 1;        // log2 of x
  double most = 1;                 // y
  double bottom_y = 0, top_y = 1;  // log2 of y
  bool logarithmic = false;        // y is logarithmic, and the ticks are round numbers
  std::vector<double> ticks_x, ticks_y;

  double plot_width() const { return width - left - right; }
  double x(double value) const {
    return left + (high > low ? (std::log2(value) - low) / (high - low) : 0.5) * plot_width();
  }
  double y(double value) const {
    const double part = logarithmic ? (std::log2(value) - bottom_y) / (top_y - bottom_y) : value / most;
    return top + (1 - part) * plot_height;
  }
};

/// A curve's marker at a point: disc, square, triangle or diamond, by index.
std::string marker(std::size_t index, double x, double y) {
  const auto shape = [&](const char* points) {
    return fmt::format("<polygon class=\"m c{}\" transform=\"translate({:.1f} {:.1f})\" points=\"{}\"/>",
                       index % styles, x, y, points);
  };
  switch (index % 4) {
    case 1:
      return shape("-4,-4 4,-4 4,4 -4,4");
    case 2:
      return shape("0,-5 5,4 -5,4");
    case 3:
      return shape("0,-5.5 5.5,0 0,5.5 -5.5,0");
    default:
      return fmt::format("<circle class=\"m c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>", index % styles, x,
                         y);
  }
}

std::set<double> all_x(const CurvePlot& plot) {
  std::set<double> values;
  for (const Curve& curve : plot.curves)
    for (const CurvePoint& point : curve.points) {
      values.insert(point.x);
      if (point.x_interval.low < point.x_interval.high)
        values.insert({point.x_interval.low, point.x_interval.high});
    }
  return values;
}

/// 1, 2 and 5 times powers of ten, from at most the least value to at least the greatest.
std::vector<double> round_ticks(double least, double most) {
  std::vector<double> ticks;
  for (double power = std::pow(10.0, std::floor(std::log10(least))); power <= most; power *= 10)
    for (const double factor : {1.0, 2.0, 5.0}) ticks.push_back(factor * power);
  ticks.push_back(10 * ticks[ticks.size() - 3]);
  while (ticks.size() > 2 && ticks[1] <= least) ticks.erase(ticks.begin());
  while (ticks.size() > 2 && ticks[ticks.size() - 2] >= most) ticks.pop_back();
  return ticks;
}

/// Axes in powers of ten that hold all points.
Axes logarithmic_axes(const CurvePlot& plot) {
  std::set<double> ys;
  for (const Curve& curve : plot.curves)
    for (const CurvePoint& point : curve.points) ys.insert({point.y.min, point.y.max});
  const std::set<double> xs = all_x(plot);
  Axes axes;
  if (xs.empty()) return axes;
  axes.logarithmic = true;
  axes.ticks_x = round_ticks(*xs.begin(), *xs.rbegin());
  axes.ticks_y = round_ticks(*ys.begin(), *ys.rbegin());
  axes.low = std::log2(axes.ticks_x.front()), axes.high = std::log2(axes.ticks_x.back());
  axes.bottom_y = std::log2(axes.ticks_y.front()), axes.top_y = std::log2(axes.ticks_y.back());
  return axes;
}

Axes make_axes(const CurvePlot& plot) {
  if (plot.logarithmic) return logarithmic_axes(plot);
  Axes axes;
  const std::set<double> values = all_x(plot);
  double most = 0;
  for (const Curve& curve : plot.curves)
    for (const CurvePoint& point : curve.points) most = std::max(most, point.y.max);
  if (!values.empty()) {
    axes.low = std::log2(*values.begin());
    axes.high = std::log2(*values.rbegin());
    // Shows all of y = x unless that squeezes the curves into less than half of the plot.
    if (plot.ideal && *values.rbegin() <= 2 * most) most = std::max(most, *values.rbegin());
  }
  axes.ticks_x.assign(values.begin(), values.end());
  axes.ticks_y = axis_ticks(most > 0 ? most : 1);
  axes.most = axes.ticks_y.back();
  return axes;
}

std::string frame(const CurvePlot& plot, const Axes& axes) {
  std::string text;
  for (const double tick : axes.ticks_y)
    text += fmt::format(
        "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text class=\"end\" "
        "x=\"{3}\" y=\"{4:.1f}\">{5}</text>",
        left, axes.width - right, axes.y(tick), left - 8, axes.y(tick) + 4, fmt::format("{:g}", tick));
  for (const double value : axes.ticks_x)
    text += fmt::format("<text class=\"mid\" x=\"{:.1f}\" y=\"{}\">{}</text>", axes.x(value),
                        height - bottom + 20, number_text(value));
  text += fmt::format("<text class=\"mid axis\" x=\"{}\" y=\"{}\">{}</text>", left + axes.plot_width() / 2,
                      height - 12, escape_html(plot.x_label));
  return text + fmt::format("<text class=\"mid axis\" transform=\"translate(16 {}) rotate(-90)\">{}</text>",
                            top + plot_height / 2, escape_html(plot.y_label));
}

/// y = x is curved over a logarithmic axis, so it is drawn in short pieces, up to the right or upper border.
std::string ideal_line(const Axes& axes) {
  std::string points;
  const double high = std::min(axes.high, std::log2(axes.most));
  for (int i = 0; i <= 64 && high >= axes.low; ++i) {
    const double value = std::exp2(axes.low + (high - axes.low) * i / 64);
    points += fmt::format("{:.1f},{:.1f} ", axes.x(value), axes.y(value));
  }
  return fmt::format("<polyline class=\"ideal\" points=\"{}\"/>", points);
}

std::string draw(const Curve& curve, std::size_t index, const Axes& axes) {
  std::string points, marks;
  for (const CurvePoint& point : curve.points) {
    const double x = axes.x(point.x);
    points += fmt::format("{:.1f},{:.1f} ", x, axes.y(point.y.median));
    marks += fmt::format(
        "<line class=\"l c{0}\" x1=\"{1:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" y2=\"{3:.1f}\"/>",
        index % styles, x, axes.y(median_interval(point.y).low), axes.y(median_interval(point.y).high));
    if (point.x_interval.low < point.x_interval.high)
      marks +=
          fmt::format("<line class=\"l c{0}\" x1=\"{1:.1f}\" x2=\"{2:.1f}\" y1=\"{3:.1f}\" y2=\"{3:.1f}\"/>",
                      index % styles, axes.x(point.x_interval.low), axes.x(point.x_interval.high),
                      axes.y(point.y.median));
    marks += fmt::format("<g><title>{}, {}: {}</title>{}</g>", escape_html(curve.name), number_text(point.x),
                         cell_text(point.y), marker(index, x, axes.y(point.y.median)));
  }
  return fmt::format("<polyline class=\"l c{} d{}\" points=\"{}\"/>{}", index % styles, index % 4, points,
                     marks);
}

struct Legend {
  std::string text;
  double height = 0;
};

/// The legend below the plot, in as many lines as the names need; empty for one curve, which the tables name.
Legend legend(const CurvePlot& plot, const Axes& axes) {
  Legend result;
  if (plot.curves.size() + plot.ideal < 2) return result;
  double x = 16, y = height + 10;
  for (std::size_t i = 0; i < plot.curves.size() + plot.ideal; ++i) {
    const bool is_ideal = i == plot.curves.size();
    const std::string name = is_ideal ? "ideal" : plot.curves[i].name;
    const double room = 40 + letter * static_cast<double>(name.size()) + 20;
    if (x > 16 && x + room > axes.width) x = 16, y += 22;
    result.text += fmt::format(
        "<line class=\"{0}\" x1=\"{1:.1f}\" x2=\"{2:.1f}\" y1=\"{3}\" y2=\"{3}\"/>{4}<text class=\"name\" "
        "x=\"{5:.1f}\" y=\"{6}\">{7}</text>",
        is_ideal ? "ideal" : fmt::format("l c{} d{}", i % styles, i % 4), x, x + 32, y,
        is_ideal ? "" : marker(i, x + 16, y), x + 40, y + 4, escape_html(name));
    x += room;
  }
  result.height = y + 12 - height;
  return result;
}

}  // namespace

std::vector<double> axis_ticks(double most) {
  const double rough = most / 5, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.5, 2.0, 1.0})
    if (factor * power >= rough * (1 - 1e-9)) step = factor * power;
  std::vector<double> ticks{0};
  while (ticks.back() < most * (1 - 1e-9)) ticks.push_back(step * static_cast<double>(ticks.size()));
  return ticks;
}

std::string svg(const CurvePlot& plot, Place place) {
  Axes axes = make_axes(plot);
  if (place == Place::column) axes.width = 400;
  const Legend names = legend(plot, axes);
  std::string text = svg_begin(place, axes.width, height + names.height, plot.title);
  text += frame(plot, axes);
  if (plot.ideal) text += ideal_line(axes);
  for (std::size_t i = 0; i < plot.curves.size(); ++i) text += draw(plot.curves[i], i, axes);
  return text + names.text + "</svg>";
}

}  // namespace sundog
