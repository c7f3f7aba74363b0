// Bands of an image's rows.
#pragma once
#include <span>
#include <vector>

namespace sundog {

/// Contiguous ranges of rows, each beginning on a multiple of 4, that divide `height` rows in
/// proportion to `shares` (not negative, not all 0; nothing is given where the share is 0). Row ranges may be
/// empty where there are more shares than rows.
struct RowRange {
  int first = 0, count = 0;
  friend bool operator==(const RowRange&, const RowRange&) = default;
};
std::vector<RowRange> divide_rows(int height, std::span<const double> shares);

}  // namespace sundog
