// A tile: a rectangle of an image's pixels, rendered as one piece of work.
#pragma once

namespace sundog {

/// In pixels; row 0 is at the top.
struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Tile&, const Tile&) = default;
};

}  // namespace sundog
