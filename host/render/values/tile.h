// A tile: a rectangle of an image's pixels, rendered as one piece of work; and what ends it early.
#pragma once
#include <atomic>

namespace sundog {

/// In pixels; row 0 is at the top.
struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Tile&, const Tile&) = default;
};

/// Checked between launches: whether to return the part finished so far.
struct StopFlags {
  const std::atomic<bool>* stop = nullptr;       // the frame is over
  const std::atomic<bool>* cancelled = nullptr;  // another device has finished the tile
  bool set() const { return (stop && stop->load()) || (cancelled && cancelled->load()); }
};

}  // namespace sundog
