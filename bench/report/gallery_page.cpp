// The gallery page's style sheet, and its HTML from plain values.
#include "bench/report/gallery_page.h"

#include <fmt/format.h>

#include "base/numbers.h"
#include "bench/report/svg.h"

namespace sundog {
namespace {

constexpr const char* gallery_style = R"(
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1c2126; --soft: #59636e; --line: #d8dde2; }
@media (prefers-color-scheme: dark) { :root { --paper: #14181c; --ink: #e6e9ec; --soft: #9aa5b0; --line: #333b43; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1400px; padding: 24px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.6em; line-height: 1.25; margin: 0 0 12px; } h2 { font-size: 1.05em; margin: 8px 0 2px; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 16px; margin: 0 0 24px; } dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 340px), 1fr)); gap: 28px 24px; }
article { border-top: 1px solid var(--line); padding-top: 12px; break-inside: avoid; }
a { color: inherit; } img { display: block; width: 100%; height: auto; }
p { margin: 0; color: var(--soft); } code { font-size: 13px; overflow-wrap: anywhere; } summary { cursor: pointer; color: var(--soft); }
@media (max-width: 640px) { body { padding: 14px; } dl { display: block; } dd { margin-bottom: 6px; } }
)";

/// "1.23 million".
std::string count_text(std::uint64_t count) {
  const auto value = static_cast<double>(count);
  if (count >= 1'000'000'000) return fmt::format("{:.3g} billion", 1e-9 * value);
  if (count >= 1'000'000) return fmt::format("{:.3g} million", 1e-6 * value);
  if (count >= 10'000) return fmt::format("{:.3g} thousand", 1e-3 * value);
  return fmt::format("{}", count);
}

std::string rays_text(const GalleryPicture& picture) {
  std::uint64_t all = 0;
  std::string kinds;
  for (const auto& [kind, count] : picture.rays) {
    all += count;
    if (count > 0) kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", count_text(count), kind);
  }
  const double rate = picture.seconds > 0 ? 1e-6 * static_cast<double>(all) / picture.seconds : 0;
  return fmt::format("{} rays, {:.3g} million a second ({})", count_text(all), rate, kinds);
}

std::string picture_html(const GalleryPicture& picture) {
  const std::string name = escape_html(picture.name), file = percent_encoded(picture.file);
  return fmt::format(
      "<article><a href=\"{1}\"><img src=\"{1}\" alt=\"The scene {0}\" width=\"{2}\" height=\"{3}\" "
      "loading=\"lazy\"></a>\n<h2>{0}</h2>\n<p>{2} x {3}, {4} {5} a pixel, {6}</p>\n<p>{7}</p>\n"
      "<details><summary>Command</summary><code>{8}</code></details></article>\n",
      name, file, picture.width, picture.height, picture.samples, picture.samples == 1 ? "sample" : "samples",
      picture.seconds >= 1 ? fmt::format("{:.3g} s", picture.seconds)
                           : fmt::format("{:.3g} ms", 1000 * picture.seconds),
      rays_text(picture), escape_html(picture.command));
}

}  // namespace

std::string gallery_html(const Gallery& gallery) {
  std::string facts, pictures;
  for (const auto& [name, value] : gallery.facts)
    facts += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(name), escape_html(value));
  for (const GalleryPicture& picture : gallery.pictures) pictures += picture_html(picture);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n"
      "<body>\n<h1>{0}</h1>\n<dl>\n{2}</dl>\n<main>\n{3}</main>\n</body>\n</html>\n",
      escape_html(gallery.title), gallery_style, facts, pictures);
}

}  // namespace sundog
