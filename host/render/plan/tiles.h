// Divides frames into tiles and limits launches; pure arithmetic.
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "render/film/film.h"

namespace sundog {

/// Tiles are aligned to this many pixels: the edge of a work-item's block on devices with vectors.
constexpr int tile_align = 4;

/// Disjoint rectangles of `edge` pixels (rounded up to a multiple of tile_align) that cover the image, row by
/// row; smaller at the right and lower edge. The order is the order of work.
std::vector<Tile> cut_tiles(int width, int height, int edge);

/// Disjoint rectangles that cover every unfinished pixel of `area`, in whole blocks of tile_align x
/// tile_align. `area` is aligned to tile_align.
std::vector<Tile> unfinished_tiles(const Film& film, const Tile& area);

/// Throws UsageError unless the region lies within a picture of this size.
void check_region(const std::optional<Tile>& region, int width, int height);

/// The pixels of the picture that a frame renders: the region grown to whole blocks of tile_align, so that
/// its pixels have the same bits as in the whole picture; without a region, the whole picture.
Tile frame_area(const std::optional<Tile>& region, int width, int height);

inline std::uint64_t pixel_count(const Tile& tile) {
  return static_cast<std::uint64_t>(tile.width) * static_cast<std::uint64_t>(tile.height);
}

/// The remaining tiles of a frame: rectangles in the order of work.
class WaitingTiles {
 public:
  WaitingTiles() = default;
  explicit WaitingTiles(const std::vector<Tile>& tiles);

  std::uint64_t pixels() const { return pixels_; }
  /// About `wanted` pixels: whole rows of the first rectangle or, if it is wide, a roughly square piece;
  /// aligned to tile_align. None when nothing is left.
  std::optional<Tile> take(std::uint64_t wanted);
  /// The first rectangle, uncut.
  std::optional<Tile> take_whole();
  /// Returns a tile, to be taken next.
  void give_back(const Tile& tile);

 private:
  std::deque<Tile> tiles_;
  std::uint64_t pixels_ = 0;
};

/// Pixel-samples of the next launch such that it takes about `target_seconds`, extrapolated from the last
/// launch. Grows at most eightfold; nonpositive times count as very short. Clamped to [least, most].
std::size_t next_launch_size(std::size_t last_size, double last_seconds, double target_seconds,
                             std::size_t least, std::size_t most);

}  // namespace sundog
