#include "render/tiles.h"

#include <algorithm>
#include <cmath>

namespace sundog {

std::vector<Tile> cut_tiles(int width, int height, int edge, int align) {
  const int step = std::max(align, (edge + align - 1) / align * align);
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += step)
    for (int x = 0; x < width; x += step)
      tiles.push_back({x, y, std::min(step, width - x), std::min(step, height - y)});
  return tiles;
}

int default_tile_edge(int width, int height, std::size_t devices) {
  const double pixels = static_cast<double>(width) * height;
  const double wanted = devices > 1 ? pixels / (16.0 * static_cast<double>(devices)) : pixels / 4.0;
  const int edge = static_cast<int>(std::sqrt(wanted));
  return std::clamp(edge / 4 * 4, 32, 128);  // small enough that a progress bar moves
}

std::size_t next_launch_size(std::size_t last_size, double last_seconds, double target_seconds,
                             std::size_t least, std::size_t most) {
  const double factor = last_seconds > 0 ? std::min(target_seconds / last_seconds, 8.0) : 8.0;
  const double size = std::clamp(static_cast<double>(last_size) * factor, static_cast<double>(least),
                                 static_cast<double>(std::max(least, most)));
  return static_cast<std::size_t>(size);
}

}  // namespace sundog
