// Makes lists of unfinished tiles from tile size, split, part and device speeds.
#include "render/frame/frame_tiles.h"

#include <algorithm>

#include "render/film/part.h"
#include "render/film/rows.h"

namespace sundog {
namespace {

/// The rows of each list of tiles: all rows, or each device's rows in a fixed split.
std::vector<RowRange> row_ranges(const Split& split, int height, std::span<const double> estimates) {
  if (split.kind == Split::Kind::dynamic) return {{0, height}};
  if (!split.shares.empty()) return divide_rows(height, split.shares);
  return divide_rows(height, estimates);
}

/// The unfinished tiles of a part of the frame that lie within `range`.
std::vector<Tile> unfinished_rows(const Film& film, const RowRange& range, const PartOfFrame& part) {
  std::vector<Tile> tiles;
  for (const RowRange& rows : part_rows(film.height, part)) {
    const int first = std::max(rows.first, range.first);
    const int end = std::min(rows.first + rows.count, range.first + range.count);
    for (const Tile& tile : unfinished_tiles(film, {0, first, film.width, std::max(0, end - first)}))
      tiles.push_back(tile);
  }
  return tiles;
}

}  // namespace

TilePlan plan_tiles(const RenderOptions& options, const Film& film, std::span<const double> estimates) {
  TilePlan plan;
  plan.whole = options.tile > 0;
  plan.exact = !options.split.shares.empty();
  for (const RowRange& range : row_ranges(options.split, film.height, estimates)) {
    std::vector<Tile> tiles;
    for (const Tile& open : unfinished_rows(film, range, options.part)) {
      if (!plan.whole) {
        tiles.push_back(open);
        continue;
      }
      for (Tile tile : cut_tiles(open.width, open.height, options.tile)) {
        tile.x += open.x;
        tile.y += open.y;
        tiles.push_back(tile);
      }
    }
    plan.lists.emplace_back(std::move(tiles));
  }
  return plan;
}

}  // namespace sundog
