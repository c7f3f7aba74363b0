// How a frame is cut and how long a launch may be: arithmetic that knows no device.
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "render/film/film.h"

namespace sundog {

/// Tiles are cut on multiples of so many pixels: the edge of a work-item's block on devices with vectors.
constexpr int tile_align = 4;

/// Rectangles of `edge` pixels (rounded up to a multiple of `align`) that cover the image without overlap,
/// row by row; those on the right and lower edge are smaller. The order is the order of work.
std::vector<Tile> cut_tiles(int width, int height, int edge, int align = tile_align);

/// Rectangles without overlap that cover every pixel of `area` that is not done (and some that are: whole
/// blocks of tile_align x tile_align are done or not). `area` begins on multiples of tile_align.
std::vector<Tile> unfinished_tiles(const Film& film, const Tile& area);

inline std::uint64_t pixel_count(const Tile& tile) {
  return static_cast<std::uint64_t>(tile.width) * static_cast<std::uint64_t>(tile.height);
}

/// The tiles of a frame that are not handed out yet: rectangles, in the order of work.
class WaitingTiles {
 public:
  WaitingTiles() = default;
  explicit WaitingTiles(const std::vector<Tile>& tiles);

  std::uint64_t pixels() const { return pixels_; }
  /// About `wanted` pixels: as many whole rows of the first rectangle as come to that, or, of a wide one, a
  /// piece that is about square; cut on multiples of tile_align. None when nothing is left.
  std::optional<Tile> take(std::uint64_t wanted);
  /// The first rectangle, uncut.
  std::optional<Tile> take_whole();
  /// To be handed out next.
  void give_back(const Tile& tile);

 private:
  std::deque<Tile> tiles_;
  std::uint64_t pixels_ = 0;
};

/// Pixel-samples for the next launch, such that it takes about `target_seconds`: from the last launch's size
/// and time. Grows at most eightfold at a step; zero or negative time counts as very short. Result in [least,
/// most].
std::size_t next_launch_size(std::size_t last_size, double last_seconds, double target_seconds,
                             std::size_t least, std::size_t most);

}  // namespace sundog
