// Sums the samples, and draws their logarithm as brightness; pixels without samples are dark blue.
#include "render/film/sampling_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sundog {

SamplingFigures sampling_figures(const std::vector<u32>& taken, const std::vector<std::uint8_t>& done,
                                 std::uint64_t surfaces, u32 each) {
  SamplingFigures figures;
  if (taken.empty()) return figures;
  const auto pixels = static_cast<double>(taken.size());
  figures.samples = std::accumulate(taken.begin(), taken.end(), std::uint64_t{0});
  figures.mean = static_cast<double>(figures.samples) / pixels;
  figures.most = *std::ranges::max_element(taken);
  std::uint64_t interpolated = 0;
  for (std::size_t i = 0; i < taken.size(); ++i) interpolated += done[i] && taken[i] == 0;
  figures.share_interpolated = static_cast<double>(interpolated) / pixels;
  figures.saved = 1 - static_cast<double>(figures.samples + surfaces) / (pixels * each);
  return figures;
}

Image sampling_picture(const std::vector<u32>& taken, int width, int height) {
  Image image(width, height, 3);
  const u32 most = taken.empty() ? 1 : std::max(1u, *std::ranges::max_element(taken));
  for (std::size_t i = 0; i < taken.size(); ++i) {
    float* pixel = image.data.data() + 3 * i;
    const float level =
        std::log2(1.0f + static_cast<float>(taken[i])) / std::log2(1.0f + static_cast<float>(most));
    pixel[0] = pixel[1] = level * level;
    pixel[2] = taken[i] == 0 ? 0.3f : level * level;
  }
  return image;
}

}  // namespace sundog
