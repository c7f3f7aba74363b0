// Finds runs of unfinished blocks, hands tiles out, and sizes launches by time.
#include "render/plan/tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sundog {
namespace {

int rounded_up(double value, int step) {
  return std::max(1, static_cast<int>(std::ceil(value / step))) * step;
}

/// Runs of blocks with unfinished pixels, within one row of blocks.
std::vector<Tile> unfinished_in_row(const Film& film, const Tile& row) {
  std::vector<Tile> runs;
  for (int x = row.x; x < row.x + row.width; x += tile_align) {
    const Tile block{x, row.y, std::min(tile_align, row.x + row.width - x), row.height};
    if (film.is_done(block)) continue;
    if (!runs.empty() && runs.back().x + runs.back().width == x)
      runs.back().width += block.width;
    else
      runs.push_back(block);
  }
  return runs;
}

}  // namespace

void check_region(const std::optional<Tile>& region, int width, int height) {
  if (!region) return;
  const auto fits = [](int first, int count, int size) {
    return first >= 0 && count > 0 && count <= size && first <= size - count;
  };
  if (!fits(region->x, region->width, width) || !fits(region->y, region->height, height))
    throw UsageError(fmt::format("the region {},{},{}x{} is not within the picture of {}x{} pixels",
                                 region->x, region->y, region->width, region->height, width, height));
}

Tile frame_area(const std::optional<Tile>& region, int width, int height) {
  if (!region) return {0, 0, width, height};
  const auto down = [](int at) { return at / tile_align * tile_align; };
  const auto up = [&](int at, int most) { return std::min(down(at + tile_align - 1), most); };
  const int x = down(region->x), y = down(region->y);
  return {x, y, up(region->x + region->width, width) - x, up(region->y + region->height, height) - y};
}

std::vector<Tile> cut_tiles(int width, int height, int edge) {
  const int step = std::max(tile_align, (edge + tile_align - 1) / tile_align * tile_align);
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += step)
    for (int x = 0; x < width; x += step)
      tiles.push_back({x, y, std::min(step, width - x), std::min(step, height - y)});
  return tiles;
}

std::vector<Tile> unfinished_tiles(const Film& film, const Tile& area) {
  std::vector<Tile> tiles;
  std::size_t above = 0;  // first run of the row above
  for (int y = area.y; y < area.y + area.height; y += tile_align) {
    const Tile row{area.x, y, area.width, std::min(tile_align, area.y + area.height - y)};
    const std::vector<Tile> runs = unfinished_in_row(film, row);
    const auto same = [&](const Tile& a, const Tile& b) {
      return a.x == b.x && a.width == b.width && a.y + a.height == b.y;
    };
    if (!runs.empty() && std::equal(tiles.begin() + static_cast<std::ptrdiff_t>(above), tiles.end(),
                                    runs.begin(), runs.end(), same)) {
      for (std::size_t i = above; i < tiles.size(); ++i) tiles[i].height += row.height;
    } else {
      above = tiles.size();
      tiles.insert(tiles.end(), runs.begin(), runs.end());
    }
  }
  return tiles;
}

WaitingTiles::WaitingTiles(const std::vector<Tile>& tiles) {
  for (const Tile& tile : tiles) {
    if (tile.width <= 0 || tile.height <= 0) continue;
    tiles_.push_back(tile);
    pixels_ += pixel_count(tile);
  }
}

std::optional<Tile> WaitingTiles::take_whole() {
  if (tiles_.empty()) return std::nullopt;
  const Tile tile = tiles_.front();
  tiles_.pop_front();
  pixels_ -= pixel_count(tile);
  return tile;
}

std::optional<Tile> WaitingTiles::take(std::uint64_t wanted) {
  std::optional<Tile> first = take_whole();
  if (!first) return first;
  Tile tile = *first;
  const double pixels = static_cast<double>(std::max<std::uint64_t>(wanted, 1));
  const double rows = pixels / tile.width;
  const int height = rows >= tile_align ? static_cast<int>(rows) / tile_align * tile_align
                                        : rounded_up(std::sqrt(pixels), tile_align);
  if (height < tile.height) {
    give_back({tile.x, tile.y + height, tile.width, tile.height - height});
    tile.height = height;
  }
  const int width = rounded_up(pixels / tile.height, tile_align);
  if (rows < tile_align && width < tile.width) {
    give_back({tile.x + width, tile.y, tile.width - width, tile.height});
    tile.width = width;
  }
  return tile;
}

void WaitingTiles::give_back(const Tile& tile) {
  tiles_.push_front(tile);
  pixels_ += pixel_count(tile);
}

std::size_t next_launch_size(std::size_t last_size, double last_seconds, double target_seconds,
                             std::size_t least, std::size_t most) {
  const double factor = last_seconds > 0 ? std::min(target_seconds / last_seconds, 8.0) : 8.0;
  const double size = std::clamp(static_cast<double>(last_size) * factor, static_cast<double>(least),
                                 static_cast<double>(std::max(least, most)));
  return static_cast<std::size_t>(size);
}

}  // namespace sundog
