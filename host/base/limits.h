// Limits of a frame; sundog refuses files and options that exceed them.
#pragma once
#include <cstdint>

namespace sundog {

constexpr int most_edge = 65536;  // width and height, in pixels
constexpr std::int64_t most_pixels = 1 << 28;
constexpr int most_parts = 65536;  // parts of a frame, for machines that share only a folder

/// Upper bound for any file of a frame: sums, weights, AOVs and progress for most_pixels.
constexpr std::uintmax_t most_frame_bytes = 80 * static_cast<std::uintmax_t>(most_pixels);

/// Whether a frame may have this size.
constexpr bool is_frame_size(std::int64_t width, std::int64_t height) {
  return width >= 1 && width <= most_edge && height >= 1 && height <= most_edge &&
         width * height <= most_pixels;
}

}  // namespace sundog
