// Finds the nearest name by optimal string alignment.
#include "base/names.h"

#include <fmt/format.h>

#include <algorithm>

namespace sundog {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; }

/// Minimum number of letters to add, drop or change, or neighbours to swap (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  const auto same = [&](std::size_t i, std::size_t j) { return lower(a[i - 1]) == lower(b[j - 1]); };
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same(i, j) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), lower);
  return result;
}

std::optional<std::string> nearest_name(std::string_view found, const std::vector<std::string>& names) {
  std::optional<std::string> best;
  if (found.size() > 100) return best;
  std::size_t best_distance = std::min(1 + (found.size() + 2) / 3, found.size());
  for (const std::string& name : names)
    if (const std::size_t distance = edit_distance(found, name); distance < best_distance) {
      best_distance = distance;
      best = name;
    }
  return best;
}

std::string did_you_mean(std::string_view found, const std::vector<std::string>& names,
                         const std::string& otherwise, std::string_view quote) {
  const auto near = nearest_name(found, names);
  return near ? fmt::format("did you mean {0}{1}{0}?", quote, *near) : otherwise;
}

}  // namespace sundog
