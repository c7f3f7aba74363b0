// The style of plots, within each of them, so that they stand alone as files too.
#include <fmt/format.h>

#include "bench/report/svg.h"

namespace sundog {
namespace {

// The curves' colours are those of Okabe and Ito's palette, which people with colour blindness can tell
// apart, darkened for white paper and lightened for dark screens.
constexpr const char* plot_rules = R"(
:root { color-scheme: light dark;
  --paper: #ffffff; --ink: #1c2126; --soft: #59636e; --line: #d8dde2; --fill: #f3f5f7; --accent: #0072b2;
  --c0: #0072b2; --c1: #c04e00; --c2: #00805e; --c3: #a8467f; --c4: #8a6d00; --c5: #2f7ea8; --c6: #1c2126; --c7: #8b3a3a; }
@media (prefers-color-scheme: dark) { :root {
  --paper: #14181c; --ink: #e6e9ec; --soft: #9aa5b0; --line: #333b43; --fill: #1d2329; --accent: #56b4e9;
  --c0: #56b4e9; --c1: #f08a3c; --c2: #2fc59a; --c3: #e193c3; --c4: #e6c34a; --c5: #9ccbea; --c6: #e6e9ec; --c7: #e58a8a; } }
@media print { :root { color-scheme: light;
  --paper: #ffffff; --ink: #000000; --soft: #444444; --line: #bbbbbb; --fill: #ffffff; --accent: #0072b2;
  --c0: #0072b2; --c1: #c04e00; --c2: #00805e; --c3: #a8467f; --c4: #8a6d00; --c5: #2f7ea8; --c6: #000000; --c7: #8b3a3a; } }
svg { font: 13px system-ui, "DejaVu Sans", sans-serif; } svg text { fill: var(--ink); } svg .mid { text-anchor: middle; } svg .end { text-anchor: end; } svg .axis { fill: var(--soft); }
svg .grid { stroke: var(--line); } svg .l { fill: none; stroke-width: 2; } svg .ideal { fill: none; stroke: var(--soft); stroke-dasharray: 2 4; stroke-width: 1.5; }
svg .d1 { stroke-dasharray: 7 3; } svg .d2 { stroke-dasharray: 3 3; } svg .d3 { stroke-dasharray: 9 3 2 3; }
svg .bar { fill: var(--accent); fill-opacity: .75; } svg .whisker { stroke: var(--ink); stroke-width: 1.5; fill: none; }
svg .on-dark { fill: #ffffff; } svg .on-light { fill: #1c2126; } svg .best { stroke: var(--ink); stroke-width: 2.5; }
svg, .heat rect { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
)";

}  // namespace

std::string plot_style() {
  std::string text = plot_rules;
  for (int i = 0; i < 8; ++i)
    text += fmt::format("svg .l.c{0} {{ stroke: var(--c{0}); }} svg .m.c{0} {{ fill: var(--c{0}); }}\n", i);
  return text;
}

std::string svg_begin(Place place, double width, double height, const std::string& title,
                      const std::string& more_style) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\"{5} viewBox=\"0 0 {0} {1}\" style=\"--width:{0}px{2}\" "
      "role=\"img\" aria-label=\"{3}\"><style>{4}</style>",
      width, height, more_style, escape_html(title), plot_style(),
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
