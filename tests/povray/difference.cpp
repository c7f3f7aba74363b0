// See difference.h.
#include "difference.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sundog::povray {

Difference difference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) throw std::invalid_argument("pictures of different sizes");
  Difference result;
  result.picture = Image(a.width, a.height, 3);
  std::vector<double> worst;
  for (int y = 0; y < a.height; y++) {
    for (int x = 0; x < a.width; x++) {
      float greatest = 0;
      for (int c = 0; c < 3; c++) {
        const float d =
            std::abs(std::clamp(a.pixel(x, y)[c], 0.0f, 1.0f) - std::clamp(b.pixel(x, y)[c], 0.0f, 1.0f));
        result.picture.pixel(x, y)[c] = 8 * d;
        greatest = std::max(greatest, d);
      }
      worst.push_back(greatest);
      result.mean += greatest;
      result.share_above_1_percent += greatest > 0.01f;
    }
  }
  std::sort(worst.begin(), worst.end());
  const auto count = static_cast<double>(worst.size());
  result.mean /= count;
  result.share_above_1_percent /= count;
  result.median = worst[worst.size() / 2];
  result.percentile_99 = worst[worst.size() * 99 / 100];
  result.greatest = worst.back();
  return result;
}

}  // namespace sundog::povray
