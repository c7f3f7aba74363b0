// Draws horizontal bars with their spread, and heat maps with the figures in the cells.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bench/report/svg.h"

namespace sundog {
namespace {

double label_room(const std::vector<std::string>& labels) {
  std::size_t longest = 4;
  for (const std::string& label : labels) longest = std::max(longest, label.size());
  return std::min(static_cast<double>(longest), 44.0) * letter + 12;
}

/// Whole labels in a page. A column has room for 18 letters, so leading words that all labels share are left
/// out.
std::vector<std::string> labels_of(const BarPlot& plot, Place place) {
  std::vector<std::string> labels;
  for (const Bar& bar : plot.bars) labels.push_back(bar.label);
  if (place == Place::page || labels.empty()) return labels;
  constexpr std::size_t most = 18;
  std::size_t same = labels.size() > 1 ? labels[0].size() : 0;
  for (const std::string& label : labels)
    same =
        static_cast<std::size_t>(std::ranges::mismatch(label, labels[0].substr(0, same)).in1 - label.begin());
  same = labels[0].substr(0, same).rfind(' ') + 1;  // 0 without a space
  const bool is_long = std::ranges::any_of(labels, [](const auto& label) { return label.size() > most; });
  for (std::string& label : labels) {
    label.erase(0, is_long ? same : 0);
    std::size_t end = std::min(most, label.size());
    while (end > 0 && end < label.size() && (label[end] & 0xC0) == 0x80) --end;  // inside a UTF-8 letter
    label.resize(end);
  }
  return labels;
}

struct ValueRange {
  double least = std::numeric_limits<double>::infinity(), most = 0;
};

ValueRange range_of(const HeatMap& map) {
  ValueRange range;
  for (const auto& row : map.values)
    for (const auto& value : row)
      if (value) range = {std::min(range.least, *value), std::max(range.most, *value)};
  return range;
}

/// From dark green (the best) through yellow to red, by the time relative to the best. Lightness rises up to
/// yellow, then hue distinguishes; the figures in the cells serve readers who see no colours.
std::string heat_color(double share) {
  constexpr std::array<std::array<double, 3>, 4> stops{
      {{26, 110, 92}, {122, 188, 120}, {247, 224, 130}, {208, 84, 60}}};
  const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t first = std::min<std::size_t>(static_cast<std::size_t>(at), stops.size() - 2);
  const double t = at - static_cast<double>(first);
  std::array<int, 3> mixed{};
  for (std::size_t i = 0; i < 3; ++i)
    mixed[i] = static_cast<int>(std::lround(stops[first][i] * (1 - t) + stops[first + 1][i] * t));
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

/// 0 at the best, 1 at twice its time.
double heat_share(double value, double least) { return least > 0 ? std::log2(value / least) : 0; }

}  // namespace

std::string svg(const BarPlot& plot, Place place) {
  const std::vector<std::string> labels = labels_of(plot, place);
  double most = 0, reach = 0.01;
  for (const Bar& bar : plot.bars) {
    most = std::max(most, bar.value.max);
    const Interval interval = median_interval(bar.value);
    for (const double value : {interval.low, bar.value.median, interval.high})
      if (value > 0 && std::isfinite(value)) reach = std::max(reach, 1.1 * std::abs(std::log(value)));
  }
  const bool narrow = place == Place::column;
  const double left = label_room(labels), row = 30, width = narrow ? 400 : 760, right = narrow ? 80 : 150;
  const double height = row * static_cast<double>(plot.bars.size()) + 44;
  const double length = width - left - right, end = axis_ticks(most > 0 ? most : 1).back();
  const auto x = [&](double value) {
    if (!plot.ratios) return left + value / end * length;
    return left + std::clamp(0.5 + 0.5 * std::log(value) / reach, 0.0, 1.0) * length;
  };
  const std::vector<double> ticks =
      plot.ratios ? std::vector{std::exp(-reach), 1.0, std::exp(reach)} : axis_ticks(end);
  std::string text = svg_begin(place, width, height, plot.title);
  for (const double tick : ticks)
    text += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"4\" y2=\"{1}\"/><text class=\"mid\" "
        "x=\"{0:.1f}\" y=\"{2}\">{3}</text>",
        x(tick), height - 40, height - 24, fmt::format("{:.3g}", tick));
  text += fmt::format("<text class=\"mid axis\" x=\"{}\" y=\"{}\">{}</text>", left + length / 2, height - 6,
                      escape_html(plot.unit));
  double y = 6;
  for (std::size_t i = 0; i < plot.bars.size(); ++i, y += row) {
    const Bar& bar = plot.bars[i];
    text += fmt::format(
        "<g><title>{}: {}</title><rect class=\"bar\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\"/>",
        escape_html(bar.label), cell_text(bar.value), plot.ratios ? x(bar.value.median) - 3 : left,
        plot.ratios ? y + 7 : y, plot.ratios ? 6 : x(bar.value.median) - left, plot.ratios ? 6 : 20);
    text += fmt::format(
        "<path class=\"whisker\" d=\"M{0:.1f} {2} v8 M{0:.1f} {3} H{1:.1f} M{1:.1f} {2} v8\"/></g>",
        x(median_interval(bar.value).low), x(median_interval(bar.value).high), y + 6, y + 10);
    text +=
        fmt::format("<text class=\"end\" x=\"{}\" y=\"{}\">{}</text><text x=\"{:.1f}\" y=\"{}\">{}</text>",
                    left - 8, y + 15, escape_html(labels[i]), x(bar.value.max) + 8, y + 15,
                    escape_html(number_text(bar.value.median) +
                                (bar.note.empty() || narrow ? "" : " (" + bar.note + ")")));
  }
  return text + "</svg>";
}

std::string svg(const HeatMap& map, Place place) {
  const double left = label_room(map.rows) + 24, top = 44, cell_h = 28;
  const double cell_w = std::clamp(((place == Place::column ? 400 : 760) - left) /
                                       static_cast<double>(std::max<std::size_t>(map.columns.size(), 1)),
                                   40.0, 84.0);
  const double width = left + cell_w * static_cast<double>(map.columns.size()) + 4,
               height = top + cell_h * static_cast<double>(map.rows.size()) + 4;
  const ValueRange range = range_of(map);
  std::string text = svg_begin(place, width, height, map.title, fmt::format(";max-width:{}px", width));
  text += fmt::format("<text class=\"mid axis\" x=\"{}\" y=\"14\">{}</text>", (left + width) / 2,
                      escape_html(map.x_label + (map.unit.empty() ? "" : "; cells in " + map.unit)));
  text += fmt::format("<text class=\"mid axis\" transform=\"translate(14 {}) rotate(-90)\">{}</text>",
                      (top + height) / 2, escape_html(map.y_label));
  for (std::size_t i = 0; i < map.columns.size(); ++i)
    text += fmt::format("<text class=\"mid\" x=\"{:.1f}\" y=\"34\">{}</text>",
                        left + cell_w * (static_cast<double>(i) + 0.5), escape_html(map.columns[i]));
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    const double y = top + cell_h * static_cast<double>(r);
    text += fmt::format("<text class=\"end\" x=\"{}\" y=\"{}\">{}</text>", left - 8, y + 18,
                        escape_html(map.rows[r]));
    for (std::size_t c = 0; c < map.values[r].size(); ++c) {
      if (!map.values[r][c]) continue;
      const double value = *map.values[r][c], share = heat_share(value, range.least),
                   x = left + cell_w * static_cast<double>(c);
      text += fmt::format(
          "<g><title>{} × {}: {} {}</title><rect class=\"cell{}\" x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" "
          "height=\"{}\" style=\"fill:{}\"/><text class=\"mid {}\" x=\"{:.1f}\" y=\"{}\">{}</text></g>",
          escape_html(map.columns[c]), escape_html(map.rows[r]), number_text(value), escape_html(map.unit),
          map.has_best && value == range.least ? " best" : "", x + 1, y + 1, cell_w - 2, cell_h - 2,
          heat_color(share), share < 0.2 || share > 0.9 ? "on-dark" : "on-light", x + cell_w / 2, y + 18,
          number_text(value));
    }
  }
  return text + "</svg>";
}

}  // namespace sundog
