// Divides a frame into parts of row bands from all over it, so that they take about equally long, and merges
// parts after checking that they belong together.
#include "render/film/part.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "base/error.h"

namespace sundog {

namespace {
constexpr int bands_a_part = 8;

constexpr std::size_t most_listed = 8, longest_setting = 60;

/// "a, b, c and 12 more".
template <class T>
std::string listed(const std::vector<T>& all) {
  const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), most_listed));
  const std::string text = fmt::format("{}", fmt::join(all.begin(), end, ", "));
  return all.size() > most_listed ? fmt::format("{} and {} more", text, all.size() - most_listed) : text;
}

std::string cut(const std::string& text) {
  return text.size() > longest_setting ? text.substr(0, longest_setting) + "..." : text;
}

/// The differing settings: "samples 16, the other samples 4".
std::string settings_difference(const PartFile& a, const PartFile& b) {
  const auto text = [](const PartFile& part, const std::string& name) {
    const auto found = part.settings.find(name);
    return found == part.settings.end() ? "no " + cut(name) : cut(name) + " " + cut(found->second);
  };
  std::map<std::string, std::string> names = a.settings;
  names.insert(b.settings.begin(), b.settings.end());
  std::vector<std::string> of_a, of_b;
  for (const auto& [name, value] : names) {
    if (text(a, name) == text(b, name)) continue;
    of_a.push_back(text(a, name));
    of_b.push_back(text(b, name));
  }
  return of_a.empty() ? "" : fmt::format("{}, the other {}", listed(of_b), listed(of_a));
}

/// Why two parts cannot belong to one frame; empty if they can.
std::string difference(const PartFile& a, const PartFile& b) {
  if (a.part.count != b.part.count)
    return fmt::format("one of {} parts, the other one of {}", b.part.count, a.part.count);
  if (a.film.width != b.film.width || a.film.height != b.film.height)
    return fmt::format("{}x{} pixels, the other {}x{}", b.film.width, b.film.height, a.film.width,
                       a.film.height);
  if (a.aovs != b.aovs)
    return fmt::format("AOVs [{}], the other [{}]", fmt::join(b.aovs, ", "), fmt::join(a.aovs, ", "));
  if (a.key == b.key) return {};
  if (const std::string settings = settings_difference(a, b); !settings.empty())
    return fmt::format("rendered with {}", settings);
  if (a.scene != b.scene) return fmt::format("of {}, the other of {}", cut(b.scene), cut(a.scene));
  return fmt::format("of another state of {}, or of a file that it names (digest {:016x}, the other {:016x})",
                     cut(b.scene), b.key, a.key);
}

void check_complete(const std::string& path, const PartFile& file) {
  for (const RowRange& rows : part_rows(file.film.height, file.part))
    if (!file.film.is_done({0, rows.first, file.film.width, rows.count}))
      throw SceneError(
          path, "",
          fmt::format("part {} of {} is not complete: render it again", file.part.index, file.part.count));
}

void check_all_there(const std::map<int, std::string>& found, int count) {
  std::vector<int> missing;
  for (int i = 1; i <= count; ++i)
    if (!found.contains(i)) missing.push_back(i);
  if (!missing.empty())
    throw SceneError(
        found.begin()->second, "",
        fmt::format(
            "part{0} {1} of {2} {3} missing: render {4} as part {5}/{2} and with the options of the others",
            missing.size() > 1 ? "s" : "", listed(missing), count, missing.size() > 1 ? "are" : "is",
            missing.size() > 1 ? "each" : "it", missing.size() > 1 ? "I" : std::to_string(missing.front())),
        Remedy::part);
}

/// Copies the finished pixels.
void add(Film& whole, const Film& part) {
  const std::size_t aovs = whole.aovs.empty() ? 0 : whole.layout.vectors();
  for (std::size_t i = 0; i < part.done.size(); ++i) {
    if (!part.done[i]) continue;
    whole.sums[i] = part.sums[i];
    whole.weights[i] = part.weights[i];
    for (std::size_t k = 0; k < aovs; ++k) whole.aovs[aovs * i + k] = part.aovs[aovs * i + k];
    if (!whole.rays.empty()) whole.rays[i] = part.rays[i];
    whole.done[i] = 1;
  }
}

}  // namespace

std::vector<RowRange> part_rows(int height, const PartOfFrame& part) {
  if (part.count <= 1) return {{0, height}};
  const int band = std::max(4, height / (part.count * bands_a_part) / 4 * 4);
  std::vector<RowRange> rows;
  for (int first = (part.index - 1) * band; first < height; first += part.count * band)
    rows.push_back({first, std::min(band, height - first)});
  return rows;
}

PartFile merge_parts(const std::vector<std::filesystem::path>& paths) {
  if (paths.empty()) throw UsageError("there are no parts to merge");
  PartFile whole;
  std::map<int, std::string> found;  // part -> its file
  for (const std::filesystem::path& path : paths) {
    PartFile file = read_part(path);
    if (found.empty()) {
      static_cast<PartHeader&>(whole) = file;
      whole.film = Film::with_aovs(file.film.width, file.film.height, file.aovs);
    } else if (const std::string why = difference(whole, file); !why.empty()) {
      throw SceneError(path.string(), "",
                       fmt::format("does not belong to {}: it is {}", found.begin()->second, why));
    }
    const auto [before, fresh] = found.emplace(file.part.index, path.string());
    if (!fresh)
      throw SceneError(
          path.string(), "",
          fmt::format("is part {} of {}, and so is {}", file.part.index, file.part.count, before->second));
    check_complete(path.string(), file);
    add(whole.film, file.film);
  }
  check_all_there(found, whole.part.count);
  whole.part = {};
  return whole;
}

}  // namespace sundog
