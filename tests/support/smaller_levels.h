// Makes all smaller mip levels of an image.
#pragma once
#include <algorithm>
#include <cstring>
#include <vector>

#include "base/pixels/image_levels.h"

namespace sundog {

/// All levels below `image`, down to 1x1.
inline std::vector<StoredImage> smaller_levels(const StoredImage& image, SampleUse use) {
  std::vector<StoredImage> levels;
  for (int width = image.width, height = image.height; width > 1 || height > 1;) {
    StoredImage& level = levels.emplace_back();
    level.width = width = std::max(1, width / 2);
    level.height = height = std::max(1, height / 2);
    level.channels = image.channels;
    level.sample = image.sample;
    level.data.resize(level.pixel_count() * level.pixel_bytes());
  }
  each_level_row(image, use, [&](std::size_t number, int y, const std::uint8_t* samples) {
    if (number == 0) return;
    StoredImage& level = levels[number - 1];
    const std::size_t row = static_cast<std::size_t>(level.width) * level.pixel_bytes();
    std::memcpy(level.data.data() + static_cast<std::size_t>(y) * row, samples, row);
  });
  return levels;
}

}  // namespace sundog
