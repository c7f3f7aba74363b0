// Divides an image's rows by shares, at multiples of the tiles' alignment.
#include "render/film/rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sundog {

std::vector<RowRange> divide_rows(int height, std::span<const double> shares) {
  constexpr int align = 4;  // the tiles' alignment
  const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
  const int bands = (height + align - 1) / align;
  std::vector<RowRange> ranges;
  double before = 0;
  int first = 0;
  for (const double share : shares) {
    before += share;
    const double end_band = total > 0 ? std::round(bands * before / total) : bands;
    const int end = std::min(height, static_cast<int>(end_band) * align);
    ranges.push_back({first, end - first});
    first = end;
  }
  return ranges;
}

}  // namespace sundog
