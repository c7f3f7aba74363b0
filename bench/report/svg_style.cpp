// The style of plots, included in each so that it also works as a file of its own.
#include <fmt/format.h>

#include "bench/report/svg.h"

namespace sundog {
namespace {

struct PlotColor {
  const char *name, *light, *dark, *print;
};

// The curves' colours are Okabe and Ito's palette, which colour-blind readers can distinguish, darkened for
// white paper and lightened for dark screens.
constexpr PlotColor plot_colors[] = {
    {"paper", "#ffffff", "#14181c", "#ffffff"}, {"ink", "#1c2126", "#e6e9ec", "#000000"},
    {"soft", "#59636e", "#9aa5b0", "#444444"},  {"line", "#d8dde2", "#333b43", "#bbbbbb"},
    {"fill", "#f3f5f7", "#1d2329", "#ffffff"},  {"accent", "#0072b2", "#56b4e9", "#0072b2"},
    {"c0", "#0072b2", "#56b4e9", "#0072b2"},    {"c1", "#c04e00", "#f08a3c", "#c04e00"},
    {"c2", "#00805e", "#2fc59a", "#00805e"},    {"c3", "#a8467f", "#e193c3", "#a8467f"},
    {"c4", "#8a6d00", "#e6c34a", "#8a6d00"},    {"c5", "#2f7ea8", "#9ccbea", "#2f7ea8"},
    {"c6", "#1c2126", "#e6e9ec", "#000000"},    {"c7", "#8b3a3a", "#e58a8a", "#8b3a3a"}};

constexpr const char* plot_rules = R"(
svg { font: 13px system-ui, "DejaVu Sans", sans-serif; } svg text { fill: var(--ink); } svg .mid { text-anchor: middle; } svg .end { text-anchor: end; } svg .axis { fill: var(--soft); }
svg .grid { stroke: var(--line); } svg .l { fill: none; stroke-width: 2; } svg .ideal { fill: none; stroke: var(--soft); stroke-dasharray: 2 4; stroke-width: 1.5; }
svg .d1 { stroke-dasharray: 7 3; } svg .d2 { stroke-dasharray: 3 3; } svg .d3 { stroke-dasharray: 9 3 2 3; }
svg .bar { fill: var(--accent); fill-opacity: .75; } svg .whisker { stroke: var(--ink); stroke-width: 1.5; fill: none; }
svg .on-dark { fill: #ffffff; } svg .on-light { fill: #1c2126; } svg .best { stroke: var(--ink); stroke-width: 2.5; }
svg, .heat rect { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
)";

}  // namespace

std::string plot_style(Place place) {
  std::string rules = plot_rules, light, dark, print;
  for (int i = 0; i < 8; ++i)
    rules += fmt::format("svg .l.c{0} {{ stroke: var(--c{0}); }} svg .m.c{0} {{ fill: var(--c{0}); }}\n", i);
  for (const auto& color : plot_colors) {
    const std::string use = fmt::format("var(--{})", color.name);
    // librsvg and other converters to PDF do not support variables.
    for (std::size_t at = 0; place == Place::column && (at = rules.find(use)) != std::string::npos;)
      rules.replace(at, use.size(), color.print);
    light += fmt::format(" --{}: {};", color.name, color.light);
    dark += fmt::format(" --{}: {};", color.name, color.dark);
    print += fmt::format(" --{}: {};", color.name, color.print);
  }
  if (place == Place::column) return rules;
  return fmt::format(
      "\n:root {{ color-scheme: light dark;{} }}\n@media (prefers-color-scheme: dark) {{ :root {{{} }} }}\n"
      "@media print {{ :root {{ color-scheme: light;{} }} }}{}",
      light, dark, print, rules);
}

std::string svg_begin(Place place, double width, double height, const std::string& title,
                      const std::string& more_style) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\"{5} viewBox=\"0 0 {0} {1}\" style=\"--width:{0}px{2}\" "
      "role=\"img\" aria-label=\"{3}\"><style>{4}</style>",
      width, height, more_style, escape_html(title), plot_style(place),
      place == Place::column ? " width=\"88mm\"" : "");
}

std::vector<std::string> report_svgs(const Report& report) {
  std::vector<std::string> all;
  for (const Part& part : report.parts)
    std::visit(
        [&](const auto& shown) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(shown)>, Table>)
            all.push_back(svg(shown, Place::column));
        },
        part);
  return all;
}

}  // namespace sundog
