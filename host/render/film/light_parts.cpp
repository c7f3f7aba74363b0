// Adjusts rounded parts by single float steps until their sum equals the colour.
#include "render/film/light_parts.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace sundog {

float sum_of(const PartValues& parts) { return std::accumulate(parts.begin(), parts.end(), 0.0f); }

namespace {

/// Whether changing part `k` alone can make the sum `whole`; otherwise restores it. Sums round to even, so
/// the sums for adjacent floats may lie on either side of `whole`.
bool fits(PartValues& parts, std::size_t k, float whole) {
  constexpr float far = std::numeric_limits<float>::infinity();
  const float before = parts[k];
  parts[k] += whole - sum_of(parts);
  for (int step = 0; step < 4; ++step) {
    const float left = whole - sum_of(parts);
    if (left == 0) return true;
    parts[k] = std::nextafter(parts[k], left > 0 ? far : -far);
  }
  parts[k] = before;
  return false;
}

/// Whether changing one nonzero part is enough; tries the largest first.
bool one_fits(PartValues& parts, float whole) {
  std::array<bool, LIGHT_PART_COUNT> tried{};
  for (std::size_t count = 0; count < parts.size(); ++count) {
    std::size_t greatest = parts.size();
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (!tried[k] && (greatest == parts.size() || std::abs(parts[k]) > std::abs(parts[greatest])))
        greatest = k;
    if (parts[greatest] == 0) return false;
    if (fits(parts, greatest, whole)) return true;
    tried[greatest] = true;
  }
  return false;
}

}  // namespace

void fit_sum(PartValues& parts, float whole) {
  if (sum_of(parts) == whole || !std::isfinite(whole)) return;
  for (std::size_t k = 0; k < 2 * parts.size(); ++k) {
    if (one_fits(parts, whole)) return;
    // Changing another part's last bit moves the sums away from the midpoints between floats.
    float& other = parts[k % parts.size()];
    if (other != 0) other = std::nextafter(other, std::numeric_limits<float>::infinity());
  }
}

}  // namespace sundog
