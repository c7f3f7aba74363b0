// Divides an image's rows into bands, one for each share of the work.
#pragma once
#include <span>
#include <vector>

namespace sundog {

/// Contiguous row ranges, each starting at a multiple of 4, that divide `height` rows in proportion to
/// `shares` (not negative, not all 0; a share of 0 gets no rows). Ranges may be empty if there are more
/// shares than rows.
struct RowRange {
  int first = 0, count = 0;
  friend bool operator==(const RowRange&, const RowRange&) = default;
};
std::vector<RowRange> divide_rows(int height, std::span<const double> shares);

}  // namespace sundog
